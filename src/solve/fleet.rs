//! Many lines at once, on all cores. Lines do not know of each other, so each comes out the same to the bit as it would alone.

use crate::error::Error;
use crate::solve::motion::Path;
use crate::solve::simulation::Simulation;
use rayon::ScopeFifo;
use rayon::prelude::*;
use std::any::Any;
use std::collections::VecDeque;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
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
    // One item needs no threads, and so does not start them.
    if items < 2 { items } else { rayon::current_num_threads().min(items) }
}

/// Does some work for every item, on all cores, and returns the results in the order of the items. A thread that has finished an
/// item takes another.
pub fn for_each<T: Send, R: Send>(items: &mut [T], work: impl Fn(&mut T) -> R + Sync) -> Vec<R> {
    if threads(items.len()) < 2 {
        return items.iter_mut().map(work).collect();
    }
    items.par_iter_mut().with_max_len(1).map(&work).collect()
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
    // A thread of the pool that waited for others of it might wait for ever.
    if threads < 2 || rayon::current_thread_index().is_some() {
        return one_by_one(lines, rows, work, gather);
    }
    let (convoy, reports) = Convoy::new(lines, rows.start, threads);
    rayon::in_place_scope_fifo(|scope| convoy.lead(scope, &reports, rows, &work, gather))
}

fn one_by_one<L, R, E>(
    lines: &mut [L],
    mut rows: Range<usize>,
    work: impl Fn(&mut L, usize) -> Result<R, E>,
    mut gather: impl FnMut(usize, Vec<R>) -> Result<(), E>,
) -> Result<(), E> {
    rows.try_for_each(|row| {
        let results: Result<_, E> = lines.iter_mut().map(|line| work(line, row)).collect();
        gather(row, results?)
    })
}

/// What a line has done in its turn, or the panic that ended it.
type Report<R, E> = (usize, Result<Vec<Result<R, E>>, Box<dyn Any + Send>>);

/// Lines on their way through the rows. The pool of threads gives each task a thread; the order in which lines move, and how far, is
/// this: the hindmost first, none far ahead of the rest.
struct Convoy<'a, L, R, E> {
    places: Mutex<Places<'a, L>>,
    reports: Sender<Report<R, E>>,
    /// As many as move at once.
    most: usize,
}

struct Places<'a, L> {
    /// Lines that nobody moves: next row, number, line.
    waiting: Vec<(usize, usize, &'a mut L)>,
    /// No line does this row yet.
    limit: usize,
    /// Tasks that move lines.
    moving: usize,
}

impl<L> Places<'_, L> {
    /// Which of those that wait is to move: the one that is farthest behind, if it may.
    fn hindmost(&self) -> Option<usize> {
        let behind = |place: &usize| (self.waiting[*place].0, self.waiting[*place].1);
        (0..self.waiting.len()).min_by_key(behind).filter(|place| self.waiting[*place].0 < self.limit)
    }
}

impl<'a, L: Send, R: Send, E: Send> Convoy<'a, L, R, E> {
    fn new(lines: &'a mut [L], start: usize, most: usize) -> (Self, Receiver<Report<R, E>>) {
        let waiting = lines.iter_mut().enumerate().map(|(number, line)| (start, number, line)).collect();
        let (reports, receiver) = channel();
        (Convoy { places: Mutex::new(Places { waiting, limit: start, moving: 0 }), reports, most }, receiver)
    }

    /// Gathers row after row on the thread of the caller, while tasks of the scope move the lines.
    fn lead<'scope>(
        &'scope self,
        scope: &ScopeFifo<'scope>,
        reports: &Receiver<Report<R, E>>,
        rows: Range<usize>,
        work: &'scope (impl Fn(&mut L, usize) -> Result<R, E> + Sync),
        mut gather: impl FnMut(usize, Vec<R>) -> Result<(), E>,
    ) -> Result<(), E> {
        let _halt = Halt(&self.places);
        let mut done: Vec<VecDeque<Result<R, E>>> = lock(&self.places).waiting.iter().map(|_| VecDeque::new()).collect();
        let limit = |row: usize| rows.end.min(row + AHEAD);
        self.open(scope, limit(rows.start), work);
        for row in rows.clone() {
            while done.iter().any(VecDeque::is_empty) {
                // The channel stays open: the convoy holds an end of it.
                let Ok((number, results)) = reports.recv() else { break };
                done[number].extend(results.unwrap_or_else(|panic| resume_unwind(panic)));
            }
            self.open(scope, limit(row + 1), work);
            let results: Result<Vec<R>, E> = done.iter_mut().filter_map(VecDeque::pop_front).collect();
            gather(row, results?)?;
        }
        Ok(())
    }

    /// Opens the rows before a limit, with as many tasks as find something to do.
    fn open<'scope>(
        &'scope self,
        scope: &ScopeFifo<'scope>,
        limit: usize,
        work: &'scope (impl Fn(&mut L, usize) -> Result<R, E> + Sync),
    ) {
        let mut places = lock(&self.places);
        places.limit = limit;
        let ready = places.waiting.iter().filter(|(row, ..)| *row < limit).count();
        let more = ready.min(self.most - places.moving);
        places.moving += more;
        drop(places);
        (0..more).for_each(|_| scope.spawn_fifo(|_| self.labour(work)));
    }

    /// What a task does: takes the line that is farthest behind a few rows on, and then the next, until none may go on.
    fn labour(&self, work: &impl Fn(&mut L, usize) -> Result<R, E>) {
        let mut places = lock(&self.places);
        while let Some(place) = places.hindmost() {
            let ((mut row, number, line), limit) = (places.waiting.swap_remove(place), places.limit);
            drop(places);
            let (began, mut results) = (Instant::now(), Vec::new());
            let turn = catch_unwind(AssertUnwindSafe(|| {
                while row < limit && (results.is_empty() || began.elapsed() < TURN) {
                    let result = work(line, row);
                    // A line that has failed has no row after that.
                    row = if result.is_ok() { row + 1 } else { usize::MAX };
                    results.push(result);
                }
            }));
            places = lock(&self.places);
            // A line whose turn ended in a panic is left aside.
            if turn.is_ok() {
                places.waiting.push((row, number, line));
            }
            // Where nobody listens any more, all is over.
            let _ = self.reports.send((number, turn.map(|()| results)));
        }
        places.moving -= 1;
    }
}

fn lock<'a, 'b, L>(places: &'a Mutex<Places<'b, L>>) -> MutexGuard<'a, Places<'b, L>> {
    // Nothing panics while it holds the lock, so a poisoned one is as good as any.
    places.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Halts all lines when it goes: also when the caller leaves with a panic.
struct Halt<'a, 'b, L>(&'a Mutex<Places<'b, L>>);

impl<L> Drop for Halt<'_, '_, L> {
    fn drop(&mut self) {
        lock(self.0).limit = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::ThreadPoolBuilder;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// `through_rows` on a number of threads.
    fn on_threads<L: Send, R: Send, E: Send>(
        threads: usize,
        lines: &mut [L],
        rows: Range<usize>,
        work: impl Fn(&mut L, usize) -> Result<R, E> + Sync,
        gather: impl FnMut(usize, Vec<R>) -> Result<(), E>,
    ) -> Result<(), E> {
        if threads < 2 {
            return one_by_one(lines, rows, work, gather);
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let (convoy, reports) = Convoy::new(lines, rows.start, threads);
        pool.in_place_scope_fifo(|scope| convoy.lead(scope, &reports, rows, &work, gather))
    }

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

    /// Rows within rows: on a thread of the pool, lines take turns on that thread and nothing waits for ever.
    #[test]
    fn a_fleet_may_be_part_of_the_work_on_an_item() {
        let mut fleets = vec![[0; 3]; 64];
        let sums = for_each(&mut fleets, |lines| {
            let mut sum = 0;
            let work = |line: &mut usize, row: usize| {
                *line += row;
                Ok::<_, ()>(*line)
            };
            let outcome = through_rows(lines, 0..100, work, |_, row| {
                sum += row.iter().sum::<usize>();
                Ok(())
            });
            outcome.map(|()| sum)
        });
        assert_eq!(sums, vec![Ok(3 * 166_650); 64]);
    }
}
