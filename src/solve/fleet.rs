//! Many lines at once, on all cores. Lines do not know of each other, so each comes out the same to the bit as it would alone.

use crate::error::Error;
use crate::solve::motion::Path;
use crate::solve::simulation::Simulation;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How many rows a line may be ahead of the last one that all lines have: bounds the memory of what waits for the others.
const AHEAD: usize = 64;
/// How long a thread stays with a line at a time, in whole rows.
const TURN: Duration = Duration::from_millis(1);

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

/// How many threads share so many items: as many as there are cores, none more than items.
pub fn threads(items: usize) -> usize {
    std::thread::available_parallelism().map_or(1, |n| n.get()).min(items)
}

/// Does some work for every item, on all cores, and returns the results in the order of the items. A thread that has finished an
/// item takes the next.
pub fn for_each<T: Send, R: Send>(items: &mut [T], work: impl Fn(&mut T) -> R + Sync) -> Vec<R> {
    let threads = threads(items.len());
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

/// Takes all lines through rows of a table, on all cores. `work` does the next row of a line; `gather` gets the results of every row, in
/// the order of the lines, as soon as all have done it, on the thread of the caller and while the lines go on. A line may be a few rows
/// ahead of the others.
///
/// Ends before the first row of which a line fails, with the error of the first line that does, or where `gather` fails. What other
/// lines have done beyond is dropped.
pub fn through_rows<L: Send, R: Send, E: Send>(
    lines: &mut [L],
    rows: Range<usize>,
    work: impl Fn(&mut L, usize) -> Result<R, E> + Sync,
    gather: impl FnMut(usize, Vec<R>) -> Result<(), E>,
) -> Result<(), E> {
    let threads = threads(lines.len());
    on_threads(threads, lines, rows, work, gather)
}

fn on_threads<L: Send, R: Send, E: Send>(
    threads: usize,
    lines: &mut [L],
    rows: Range<usize>,
    work: impl Fn(&mut L, usize) -> Result<R, E> + Sync,
    mut gather: impl FnMut(usize, Vec<R>) -> Result<(), E>,
) -> Result<(), E> {
    if threads < 2 {
        for row in rows {
            let results: Result<_, E> = lines.iter_mut().map(|line| work(line, row)).collect();
            gather(row, results?)?;
        }
        return Ok(());
    }
    let convoy = Convoy::new(lines, rows.clone());
    std::thread::scope(|scope| {
        let _end = End(&convoy);
        (0..threads).for_each(|_| drop(scope.spawn(|| convoy.labour(&work))));
        for row in rows {
            let Some(results) = convoy.collect() else { break };
            gather(row, results?)?;
        }
        Ok(())
    })
}

/// Lines on their way through the rows, shared by the threads.
struct Convoy<'a, L, R, E> {
    places: Mutex<Places<'a, L, R, E>>,
    /// A line has moved, or a row was gathered, or all is over.
    changed: Condvar,
    end: usize,
}

struct Places<'a, L, R, E> {
    /// Lines that no thread is at: next row, number, line.
    waiting: Vec<(usize, usize, &'a mut L)>,
    /// What each line has done and nobody has gathered.
    done: Vec<VecDeque<Result<R, E>>>,
    /// Next row to gather.
    row: usize,
    over: bool,
}

impl<'a, L, R, E> Convoy<'a, L, R, E> {
    fn new(lines: &'a mut [L], rows: Range<usize>) -> Self {
        let done = lines.iter().map(|_| VecDeque::new()).collect();
        let waiting = lines.iter_mut().enumerate().map(|(number, line)| (rows.start, number, line)).collect();
        let places = Mutex::new(Places { waiting, done, row: rows.start, over: false });
        Convoy { places, changed: Condvar::new(), end: rows.end }
    }

    fn lock(&self) -> MutexGuard<'_, Places<'a, L, R, E>> {
        // Nothing panics while it holds the lock, so a poisoned one is as good as any.
        self.places.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'b>(&self, places: MutexGuard<'b, Places<'a, L, R, E>>) -> MutexGuard<'b, Places<'a, L, R, E>> {
        self.changed.wait(places).unwrap_or_else(PoisonError::into_inner)
    }

    /// What a thread does: takes the line that is farthest behind a few rows on, and then the next, until all is over.
    fn labour(&self, work: &impl Fn(&mut L, usize) -> Result<R, E>) {
        let _end = End(self);
        let mut places = self.lock();
        while !places.over {
            let limit = self.end.min(places.row + AHEAD);
            let hindmost = (0..places.waiting.len()).min_by_key(|place| (places.waiting[*place].0, places.waiting[*place].1));
            let Some(place) = hindmost.filter(|place| places.waiting[*place].0 < limit) else {
                places = self.wait(places);
                continue;
            };
            let (mut row, number, line) = places.waiting.swap_remove(place);
            drop(places);
            let (began, mut results) = (Instant::now(), Vec::new());
            while row < limit && (results.is_empty() || began.elapsed() < TURN) {
                let result = work(line, row);
                // A line that has failed has no row after that.
                row = if result.is_ok() { row + 1 } else { self.end };
                results.push(result);
            }
            places = self.lock();
            places.done[number].extend(results);
            places.waiting.push((row, number, line));
            self.changed.notify_all();
        }
    }

    /// Waits until all lines have done the next row, and takes it; none where a thread ended before its time.
    fn collect(&self) -> Option<Result<Vec<R>, E>> {
        let mut places = self.lock();
        while !places.over && places.done.iter().any(VecDeque::is_empty) {
            places = self.wait(places);
        }
        if places.over {
            return None;
        }
        places.row += 1;
        self.changed.notify_all();
        places.done.iter_mut().map(VecDeque::pop_front).collect::<Option<Vec<_>>>().map(|row| row.into_iter().collect())
    }
}

/// Ends the work of all threads when it goes: also when the thread that has it panics, so that no other waits for it.
struct End<'a, 'b, L, R, E>(&'a Convoy<'b, L, R, E>);

impl<L, R, E> Drop for End<'_, '_, L, R, E> {
    fn drop(&mut self) {
        self.0.lock().over = true;
        self.0.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Number of a line, and a row.
    type Place = (usize, usize);

    /// Lines of unequal speed go through rows 1 to 299; those in `failing` fail at a row. Returns the rows gathered, and the outcome.
    fn travel(threads: usize, failing: &[Place]) -> (Vec<Vec<Place>>, Result<(), Place>) {
        let mut lines: Vec<Place> = (0..7).map(|number| (number, 0)).collect();
        let (mut rows, gathered) = (Vec::new(), AtomicUsize::new(0));
        let outcome = on_threads(
            threads,
            &mut lines,
            1..300,
            |(number, before), row| {
                assert_eq!((*before + 1, row <= gathered.load(Ordering::SeqCst) + AHEAD + 1), (row, true), "line {number}");
                *before = row;
                std::thread::sleep(Duration::from_micros(if row % 7 == *number { 100 } else { 0 }));
                if failing.contains(&(*number, row)) { Err((*number, row)) } else { Ok((*number, row)) }
            },
            |row, results| {
                rows.push(results);
                gathered.store(row, Ordering::SeqCst);
                Ok(())
            },
        );
        (rows, outcome)
    }

    /// On any number of threads all rows arrive, whole and in order, and no line runs away from the others.
    #[test]
    fn rows_are_gathered_in_order_and_no_line_runs_away() {
        for threads in [1, 2, 5] {
            let (rows, outcome) = travel(threads, &[]);
            let expected: Vec<Vec<_>> = (1..300).map(|row| (0..7).map(|number| (number, row)).collect()).collect();
            assert_eq!((rows, outcome), (expected, Ok(())), "{threads} threads");
        }
    }

    /// Of several lines that fail, the first row decides, and in it the first line.
    #[test]
    fn the_first_failure_ends_the_journey() {
        for threads in [1, 2, 5] {
            let (rows, outcome) = travel(threads, &[(0, 130), (2, 101), (5, 101), (6, 102)]);
            assert_eq!((rows.len(), outcome), (100, Err((2, 101))), "{threads} threads");
        }
    }

    /// Where a row cannot be gathered, all threads end; a panic comes through and stops nobody for ever.
    #[test]
    fn nobody_waits_for_one_that_has_left() {
        for threads in [1, 2, 5] {
            let full =
                on_threads(threads, &mut [0; 9], 0..1000, |_, row| Ok(row), |row, _| if row < 3 { Ok(()) } else { Err(row) });
            assert_eq!(full, Err(3), "{threads} threads");
            let panics = |_: &mut i32, row| if row < 20 { Ok::<_, ()>(row) } else { panic!("a fault of this test") };
            let caught = std::panic::catch_unwind(|| on_threads(threads, &mut [0; 9], 0..1000, panics, |_, _| Ok(())));
            assert!(caught.is_err(), "{threads} threads");
        }
    }

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
