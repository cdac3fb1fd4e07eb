//! Events on their way from the tick to whoever logs them.

use crate::event::{Event, Place};

/// A ring of at most `N` events, a power of two.
///
/// Both counts may hold any value: where they contradict each other, the events in the
/// ring are given up, and nothing outside of it is read or written.
#[derive(Debug)]
pub struct Queue<const N: usize> {
    events: [Event; N],
    /// Events put in since the start, and taken out; both wrap around.
    put: u32,
    taken: u32,
}

impl<const N: usize> Queue<N> {
    /// Of zeros, so that an empty ring takes no flash.
    const NOTHING: Event = Event::Touch {
        place: Place::new(0, 0),
        number: 0,
    };

    /// Empty.
    pub const fn new() -> Self {
        // The counts wrap around in step with the ring.
        const { assert!(N.is_power_of_two() && N <= 1 << 16) };
        Self {
            events: [Self::NOTHING; N],
            put: 0,
            taken: 0,
        }
    }

    /// Puts an event in, for the writer. Events are few and told from many places, so
    /// that this stands in flash once.
    ///
    /// # Errors
    /// The event, if there is no room.
    #[inline(never)]
    pub fn put(&mut self, event: Event) -> Result<(), Event> {
        if self.waiting() == N {
            return Err(event);
        }
        self.events[self.put as usize % N] = event;
        self.put = self.put.wrapping_add(1);
        Ok(())
    }

    /// Takes the oldest event out, for the reader.
    #[inline]
    pub fn take(&mut self) -> Option<Event> {
        if self.waiting() == 0 {
            return None;
        }
        let event = self.events[self.taken as usize % N];
        self.taken = self.taken.wrapping_add(1);
        Some(event)
    }

    /// How many events wait. More than there is room for cannot be: they are given up.
    #[inline]
    fn waiting(&mut self) -> usize {
        let waiting = self.put.wrapping_sub(self.taken) as usize;
        if waiting > N {
            self.taken = self.put;
            return 0;
        }
        waiting
    }
}

impl<const N: usize> Default for Queue<N> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::Queue;
    use crate::event::{Event, Place};

    fn touch(number: u16) -> Event {
        let place = Place::new(1, 0);
        Event::Touch { place, number }
    }

    #[test]
    fn events_leave_in_the_order_in_which_they_came() {
        let mut queue = Queue::<4>::new();
        // As close to the wrap of the counts as it gets.
        (queue.put, queue.taken) = (u32::MAX - 1, u32::MAX - 1);
        assert_eq!(queue.take(), None);
        for number in 0..10 {
            assert_eq!(queue.put(touch(number)), Ok(()));
            assert_eq!(queue.put(touch(number + 100)), Ok(()));
            assert_eq!(queue.take(), Some(touch(number)));
            assert_eq!(queue.take(), Some(touch(number + 100)));
            assert_eq!(queue.take(), None);
        }
    }

    #[test]
    fn a_full_queue_gives_the_event_back() {
        let mut queue = Queue::<4>::new();
        for number in 0..4 {
            assert_eq!(queue.put(touch(number)), Ok(()));
        }
        assert_eq!(queue.put(touch(4)), Err(touch(4)));
        assert_eq!(queue.take(), Some(touch(0)));
        assert_eq!(queue.put(touch(5)), Ok(()));
    }

    #[test]
    fn counts_that_contradict_each_other_are_survived() {
        for bit in 0..32 {
            for is_put in [false, true] {
                let mut queue = Queue::<4>::new();
                let _ = queue.put(touch(1));
                let count = if is_put {
                    &mut queue.put
                } else {
                    &mut queue.taken
                };
                *count ^= 1 << bit;
                let left = (0..=4).map_while(|_| queue.take()).count();
                assert!(left <= 4, "bit {bit}");
                assert_eq!(queue.put(touch(2)), Ok(()), "bit {bit}");
                assert_eq!(queue.take(), Some(touch(2)), "bit {bit}");
            }
        }
    }
}
