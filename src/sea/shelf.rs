//! Things kept by a key for as long as there is room: whichever was not used for longest makes room.

/// Places at most.
const ROOM: usize = 16_384;
/// Places at which a thing may be kept.
const PROBES: usize = 4;
/// Things asked for within this many moments do not make room; the memory grows instead.
pub const RECENT: u64 = 8;
/// A key: a cell of space, and a time.
pub type Key = (i64, i64);

/// The shelf.
#[derive(Debug)]
pub struct Shelf<T> {
    keys: Vec<Key>,
    /// Moments at which they were last asked for.
    used: Vec<u64>,
    /// What is kept, at the places that `place` tells.
    pub things: Vec<T>,
}

impl<T: Clone> Shelf<T> {
    /// A shelf of empty things that has a number of places at first, a power of two.
    pub fn new(empty: T, room: usize) -> Shelf<T> {
        Shelf { keys: vec![(i64::MAX, i64::MAX); room], used: vec![0; room], things: vec![empty; room] }
    }

    /// Where a thing is kept, and whether it still has to be put there.
    #[inline(always)]
    pub fn place(&mut self, key: Key, moment: u64) -> (usize, bool) {
        loop {
            let last = self.keys.len() - 1;
            let mixed = (key.0 as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (key.1 as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
            let start = ((mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32) as usize & last;
            let mut oldest = start;
            for probe in 0..PROBES {
                let at = (start + probe) & last;
                if self.keys[at] == key {
                    self.used[at] = moment;
                    return (at, false);
                }
                if self.used[at] < self.used[oldest] {
                    oldest = at;
                }
            }
            if self.used[oldest] + RECENT > moment && self.keys.len() < ROOM {
                let (room, empty) = (2 * self.keys.len(), self.things[0].clone());
                (self.keys, self.used, self.things) = (vec![(i64::MAX, i64::MAX); room], vec![0; room], vec![empty; room]);
                continue;
            }
            (self.keys[oldest], self.used[oldest]) = (key, moment);
            return (oldest, true);
        }
    }
}
