//! Sums by cells (`near`) at points that move little, several side by side: each keeps the polynomials of the cell and the slot that it is in.
//!
//! What a point keeps is known by cell and slot, which follow from place and time alone: it is asked for again whenever they change, so that
//! answers do not depend on where a point was before.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real};
use crate::sea::layer::{MOTION, POWERS, SWELL, TERMS};
use crate::sea::near::{Near, Now};
use pulp::Simd;

/// A number for each of the points of a block.
type Row = [f64; MOST_LANES];

/// Points in blocks, and the polynomials of one direction of travel at each.
#[derive(Debug, Clone)]
pub struct Columns {
    swells: Vec<Swell>,
    blocks: Vec<Block>,
    time: f64,
    /// This time in the slots of every layer.
    now: Vec<Now>,
}

/// The elevation at the points of a block.
#[derive(Debug, Clone)]
struct Swell {
    /// Coefficients, by power of time and of place.
    rows: [Row; SWELL],
    /// Columns of cells; infinite where nothing is kept.
    columns: Row,
    /// The slot that they are of.
    slots: [i64; MOST_LANES],
}

/// The velocity at the points of a block.
#[derive(Debug, Clone)]
struct Block {
    /// Coefficients: real, then imaginary parts for each power of time.
    motion: [Row; MOTION],
    held: [Held; MOST_LANES],
    /// Of the cells of velocities: column, 1/width, middle along and up, upper edge and lower edge [m].
    cells: [Row; 6],
    /// Times in their slots, and 2 over the length of a slot [1/s]; of the time `time`.
    shares: Row,
    rates: Row,
    time: f64,
}

/// A layer and a slot in it; the layer behind the last stands for water at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Held {
    layer: usize,
    slot: i64,
}

/// Of `Block::cells`.
const COLUMN: usize = 0;
const PER_WIDTH: usize = 1;
const MIDDLE: usize = 2;
const HEIGHT: usize = 3;
const TOP: usize = 4;
const BOTTOM: usize = 5;

impl Block {
    fn new(layers: usize) -> Block {
        let nothing = [f64::INFINITY; MOST_LANES];
        Block {
            motion: [[0.0; MOST_LANES]; MOTION],
            held: [Held { layer: layers, slot: 0 }; MOST_LANES],
            // Above any upper edge.
            cells: [nothing, [0.0; MOST_LANES], [0.0; MOST_LANES], [0.0; MOST_LANES], [f64::NEG_INFINITY; MOST_LANES], nothing],
            shares: [0.0; MOST_LANES],
            rates: [0.0; MOST_LANES],
            time: f64::NAN,
        }
    }
}

/// The whole number next to x, halves to the even one, for |x| < 2⁵¹.
#[inline(always)]
fn rounded<F: Real>(x: F) -> F {
    const ROUND: f64 = 6_755_399_441_055_744.0;
    (x + ROUND) + -ROUND
}

/// Points that are asked for side by side.
#[derive(Debug, Clone, Copy)]
pub struct Asked<V: Simd> {
    /// Number of the first; they are of one block.
    pub at: usize,
    /// When [s].
    pub time: f64,
    /// Where along the direction of travel [m].
    pub along: Lanes<V>,
    /// 1 where the answer is looked at, else 0.
    pub wanted: Lanes<V>,
}

/// Greater than zero where two numbers differ.
#[inline(always)]
fn apart<F: Real>(one: F, other: F) -> F {
    let apart = one - other;
    apart.max(-apart)
}

impl Columns {
    /// Room for points in blocks of `MOST_LANES`, and behind them for more blocks of points of which the elevation alone is asked for.
    pub fn new(near: &Near, blocks: usize, more: usize) -> Columns {
        let layers = near.layers();
        let nothing = [f64::INFINITY; MOST_LANES];
        let swell = Swell { rows: [[0.0; MOST_LANES]; SWELL], columns: nothing, slots: [0; MOST_LANES] };
        Columns {
            swells: vec![swell; blocks + more],
            blocks: vec![Block::new(layers.len()); blocks],
            time: f64::NAN,
            now: layers.iter().map(|layer| Now::new(layer, 0.0)).collect(),
        }
    }

    fn tick(&mut self, near: &Near, time: f64) {
        if time != self.time {
            self.time = time;
            self.now.iter_mut().zip(near.layers()).for_each(|(now, layer)| *now = Now::new(layer, time));
        }
    }

    /// Σ a cos θ [m] at points.
    #[inline(always)]
    pub fn elevation<V: Simd>(&mut self, cpu: V, near: &Near, asked: &Asked<V>) -> Lanes<V> {
        let Asked { at, time, along, wanted } = *asked;
        self.tick(near, time);
        let (layer, now) = (&near.layers()[0], self.now[0]);
        let (swell, first) = (&mut self.swells[at / MOST_LANES], at % MOST_LANES);
        let column = rounded(along * layer.per_width);
        let moved = (apart(column, Lanes::load(cpu, &swell.columns, first)) * wanted).any_positive();
        if moved || swell.slots[first..first + V::F64_LANES].iter().any(|slot| *slot != now.slot) {
            let (columns, wanted) = (column.lanes(), wanted.lanes());
            for lane in (0..V::F64_LANES).filter(|lane| wanted[*lane] > 0.0) {
                let to = first + lane;
                if swell.columns[to] != columns[lane] || swell.slots[to] != now.slot {
                    near.put_swell(time, columns[lane] as i64, &mut swell.rows, to);
                    (swell.columns[to], swell.slots[to]) = (columns[lane], now.slot);
                }
            }
        }
        let share = Lanes::<V>::splat(cpu, now.share);
        let x = along - column * (2.0 * layer.half);
        let mut sum = swell.term(cpu, first, share, TERMS - 1);
        let mut m = TERMS - 1;
        while m > 0 {
            m -= 1;
            sum = sum.mul_add(x, swell.term(cpu, first, share, m));
        }
        sum
    }

    /// u, w, ∂u/∂t and ∂w/∂t at points, and at levels z′ [m].
    #[inline(always)]
    pub fn motion<V: Simd>(&mut self, cpu: V, near: &Near, asked: &Asked<V>, level: Lanes<V>) -> [Lanes<V>; 4] {
        let Asked { at, time, along, wanted } = *asked;
        self.tick(near, time);
        let (block, first) = (&mut self.blocks[at / MOST_LANES], at % MOST_LANES);
        if block.time != time {
            block.refresh(near, &self.now, time);
        }
        let column = rounded(along * block.cell(cpu, first, PER_WIDTH));
        let left = apart(column, block.cell(cpu, first, COLUMN))
            .max((level - block.cell(cpu, first, TOP)).positive())
            .max((block.cell(cpu, first, BOTTOM) - level).step());
        if (left * wanted).any_positive() {
            let (along, level, left, wanted) = (along.lanes(), level.lanes(), left.lanes(), wanted.lanes());
            for lane in (0..V::F64_LANES).filter(|lane| wanted[*lane] > 0.0 && left[*lane] > 0.0) {
                block.put(near, &self.now, time, first + lane, along[lane], level[lane]);
            }
        }
        let share = Lanes::<V>::load(cpu, &block.shares, first);
        // ζ = z + ix from the middle of the cell.
        let (up, off) = (level - block.cell(cpu, first, HEIGHT), along - block.cell(cpu, first, MIDDLE));
        let ((mut u, mut du), (mut w, mut dw)) =
            (block.term(cpu, first, share, TERMS - 1), block.term(cpu, first, share, 2 * TERMS - 1));
        let mut m = TERMS - 1;
        while m > 0 {
            m -= 1;
            let ((re, re_rate), (im, im_rate)) = (block.term(cpu, first, share, m), block.term(cpu, first, share, TERMS + m));
            (u, w) = (u.mul_add(up, w.mul_add(-off, re)), w.mul_add(up, u.mul_add(off, im)));
            (du, dw) = (du.mul_add(up, dw.mul_add(-off, re_rate)), dw.mul_add(up, du.mul_add(off, im_rate)));
        }
        let rates = Lanes::load(cpu, &block.rates, first);
        [u, w, du * rates, dw * rates]
    }
}

impl Swell {
    /// Term `m` of the polynomial of the elevation in place, at a share of the slot.
    #[inline(always)]
    fn term<V: Simd>(&self, cpu: V, first: usize, share: Lanes<V>, m: usize) -> Lanes<V> {
        let mut sum = Lanes::load(cpu, &self.rows[(POWERS - 1) * TERMS + m], first);
        let mut n = POWERS - 1;
        while n > 0 {
            n -= 1;
            sum = sum.mul_add(share, Lanes::load(cpu, &self.rows[n * TERMS + m], first));
        }
        sum
    }
}

impl Block {
    /// A row of the cells of the points from `first` on.
    #[inline(always)]
    fn cell<V: Simd>(&self, cpu: V, first: usize, row: usize) -> Lanes<V> {
        Lanes::load(cpu, &self.cells[row], first)
    }

    /// Term `m` of the polynomial of the velocity in place at a share of the slot, and its rate per share of the slot.
    #[inline(always)]
    fn term<V: Simd>(&self, cpu: V, first: usize, share: Lanes<V>, m: usize) -> (Lanes<V>, Lanes<V>) {
        let mut rate = Lanes::load(cpu, &self.motion[(POWERS - 1) * 2 * TERMS + m], first);
        let mut sum = rate.mul_add(share, Lanes::load(cpu, &self.motion[(POWERS - 2) * 2 * TERMS + m], first));
        let mut n = POWERS - 2;
        while n > 0 {
            n -= 1;
            rate = rate.mul_add(share, sum);
            sum = sum.mul_add(share, Lanes::load(cpu, &self.motion[n * 2 * TERMS + m], first));
        }
        (sum, rate)
    }

    /// The times in the slots of what is kept. What has got into another slot is to be put anew.
    fn refresh(&mut self, near: &Near, now: &[Now], time: f64) {
        self.time = time;
        for lane in 0..MOST_LANES {
            let held = self.held[lane];
            let Some(of) = now.get(held.layer) else { continue };
            self.shares[lane] = of.share;
            if of.slot != held.slot {
                // In the same cell as before, unless it is asked for elsewhere.
                let column = self.cells[COLUMN][lane];
                if column.is_finite() {
                    near.put_motion(time, held.layer, column as i64, &mut self.motion, lane);
                    self.held[lane].slot = of.slot;
                }
            }
        }
    }

    /// Keeps the polynomial of the velocity at a place.
    #[inline(never)]
    fn put(&mut self, near: &Near, now: &[Now], time: f64, lane: usize, along: f64, level: f64) {
        let layers = near.layers();
        let Some((layer, of)) = near.layer_at(level).map(|layer| (layer, &layers[layer])) else {
            let bottom = layers.last().map_or(0.0, |last| last.middle - last.half);
            self.motion.iter_mut().for_each(|row| row[lane] = 0.0);
            self.held[lane] = Held { layer: layers.len(), slot: 0 };
            let cell = [0.0, 0.0, 0.0, 0.0, bottom, f64::NEG_INFINITY];
            self.cells.iter_mut().zip(cell).for_each(|(row, number)| row[lane] = number);
            (self.shares[lane], self.rates[lane]) = (0.0, 0.0);
            return;
        };
        let column = rounded(along * of.per_width);
        near.put_motion(time, layer, column as i64, &mut self.motion, lane);
        self.held[lane] = Held { layer, slot: now[layer].slot };
        let cell = [column, of.per_width, column * (2.0 * of.half), of.middle, of.middle + of.half, of.middle - of.half];
        self.cells.iter_mut().zip(cell).for_each(|(row, number)| row[lane] = number);
        (self.shares[lane], self.rates[lane]) = (now[layer].share, 2.0 / of.slot);
    }
}
