//! A sample under templates; the last one of a window decides.
#![cfg_attr(target_os = "none", no_std, no_main)]

use classifiers::template::{Template, TemplateState};
use count::arguments::Two;
use count::samples::{codes, spread};

/// Samples in a window.
const WINDOW: usize = 250;

/// Codes that differ from sample to sample.
const fn table<const N: usize>() -> [i16; N] {
    let mut table = [0; N];
    let mut i = 0;
    while i < N {
        table[i] = (i as i16).wrapping_mul(16_381);
        i += 1;
    }
    table
}

/// A whisker's two channels and four classes.
const SMALL: Template<'_, 2, 4> = {
    static TABLE: [i16; WINDOW * 8] = table();
    match Template::new(&TABLE) {
        Ok(template) => template,
        Err(_) => panic!("whole samples"),
    }
};

/// Six whiskers and nine classes (BIOTACT).
const LARGE: Template<'_, 12, 9> = {
    static TABLE: [i16; WINDOW * 108] = table();
    match Template::new(&TABLE) {
        Ok(template) => template,
        Err(_) => panic!("whole samples"),
    }
};

count::program!(
    ("integer": "template push C=2 K=4",
        (codes: Two<i32>, state: &mut TemplateState<4>) -> u32 {
            let choice = SMALL.push(state, &[codes.0 as i16, codes.1 as i16]);
            choice.map_or(0, |choice| choice.samples())
        },
        codes, SMALL.state()),
    ("integer": "template push C=12 K=9",
        (codes: &'static [i16; 12], state: &mut TemplateState<9>) -> u32 {
            LARGE.push(state, codes).map_or(0, |choice| choice.samples())
        },
        heard, LARGE.state()),
);

/// Twelve codes.
fn heard(call: u32) -> &'static [i16; 12] {
    static HEARD: [i16; 64 + 12] = table();
    let from = spread(call, 0.0, 63.0) as usize;
    let codes = HEARD[from..].first_chunk();
    codes.expect("twelve more than the largest beginning")
}
