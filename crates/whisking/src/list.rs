//! Lists of limited length.

use heapless::Vec;

/// Items for which it has no room are left out.
#[inline]
pub(crate) fn listed<T, const N: usize>(items: impl IntoIterator<Item = T>) -> Vec<T, N> {
    let mut list = Vec::new();
    for item in items {
        if list.push(item).is_err() {
            break;
        }
    }
    list
}
