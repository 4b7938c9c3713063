//! Many lines at once, on all cores. Lines do not know of each other, so each comes out the same to the bit as it would alone.

use crate::error::Error;
use crate::solve::motion::Path;
use crate::solve::simulation::Simulation;
use std::sync::{Mutex, PoisonError};

/// A line and the motion of its fairlead.
pub struct Moored {
    /// The line.
    pub simulation: Simulation,
    /// The path of its fairlead.
    pub path: Path,
}

/// Advances every line to a time. A line that fails stands as it was, with its error in its place; the others go on.
pub fn advance(lines: &mut [Moored], until: f64) -> Vec<Result<(), Error>> {
    for_each(lines, |line| line.simulation.advance(until, &line.path))
}

/// Does some work for every item, on as many threads as there are cores (none more than items), and returns the results in the
/// order of the items. A thread that has finished an item takes the next.
pub fn for_each<T: Send, R: Send>(items: &mut [T], work: impl Fn(&mut T) -> R + Sync) -> Vec<R> {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get()).min(items.len());
    if threads < 2 {
        return items.iter_mut().map(work).collect();
    }
    let mut results: Vec<Option<R>> = items.iter().map(|_| None).collect();
    let queue = Mutex::new(items.iter_mut().zip(&mut results));
    // Nothing panics while it holds the lock, so a poisoned one is as good as any.
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let labour = || {
        while let Some((item, result)) = next() {
            *result = Some(work(item));
        }
    };
    std::thread::scope(|scope| {
        (1..threads).for_each(|_| drop(scope.spawn(labour)));
        labour();
    });
    results.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every item is worked on once, and its result stands at its place.
    #[test]
    fn results_keep_the_order_of_the_items() {
        let mut items: Vec<usize> = (0..1000).collect();
        let results = for_each(&mut items, |item| {
            *item += 1;
            2 * *item
        });
        assert_eq!(items, (1..=1000).collect::<Vec<_>>());
        assert_eq!(results, (1..=1000).map(|n| 2 * n).collect::<Vec<_>>());
    }
}
