//! Many waves of one direction, near a place and for a while: polynomials in place and time that stand for all of them.
//!
//! ```text
//! Σ B e^(kζ - iωτ) = Σ_j S_j e^(k_j ζ - i ω_j τ),   S_j = Σ B L_j(ω)                              near a place, for a while (a span)
//!                  = Σ_m Σ_n c_mn ζ^m s^n,          s = (τ - τ₀)/half a slot                      near a place, for a moment (a slot)
//! ```
//!
//! B complex amplitude of a component at the middle of a cell of space and of a span of time, ζ = z + ix and τ place and time from there,
//! ω_j Chebyshev's points between the lowest and the highest frequency, L_j Lagrange's polynomials through them, k_j = k(ω_j). As a
//! function of ω, e^(kζ - iωτ) is a polynomial of degree 15 as long as ζ and τ are small enough; so the sums over components are taken
//! once for a cell and a span, or, where components are many, over those that stand for them in a `region`. A slot is a part of a span that is short enough for a polynomial of degree 5 in time; its coefficients are
//! sums over the sixteen S_j, and a point of the line costs a polynomial of 8 × 6 terms and its rate, however many components there are.
//!
//! Velocities of a plane flow are analytic: u + iw = Σ B e^(kζ) + Σ B′* e^(-kζ), B′ what the bed sends back. Sizes of cells and slots are such
//! that what the series leave out is `ERROR` of the velocity at the surface, both as standard deviations: the deeper a cell, the less
//! components reach it, the larger it is, and the longer its slots. Elevations have cells of their own, on z = 0.
//!
//! All numbers kept are functions of cell, span and slot alone: whatever was asked for before, and whatever had to make room,
//! answers have the same bits.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::scene::types::Stretching;
use crate::sea::layer::{Layer, MOTION, Member, POWERS, STAND, SWELL, TERMS, Water};
use crate::sea::region::{NODES, Region};
use crate::sea::shelf::{RECENT, Shelf};
use crate::sea::stretching::{Level, SHALLOWEST};
use pulp::{Arch, Simd, WithSimd};
use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, PoisonError};

/// Cells near the surface must have at least this share of the significant wave height, or a line would leave them too often.
const SMALLEST: f64 = 0.05;
/// Places on a shelf at first: of what is kept for a region, and for a cell.
const FEW: usize = 16;
const MANY: usize = 256;
/// Fewer components are summed one by one.
const LEAST: usize = 32;

/// Components of one direction, with a memory of the sums last taken.
#[derive(Debug)]
pub struct Near {
    plan: Arc<Plan>,
    memory: Mutex<Memory>,
}

impl Clone for Near {
    fn clone(&self) -> Near {
        Near { plan: self.plan.clone(), memory: Mutex::new(Memory::new(&self.plan)) }
    }
}

/// What does not change.
#[derive(Debug)]
struct Plan {
    water: Water,
    cos: f64,
    sin: f64,
    /// k/2π, ω/2π and φ/2π.
    turns: [Vec<f64>; 3],
    /// Where there are many components: what stands for them in a region.
    region: Option<Region>,
    /// The layer of elevations, and those of velocities from the surface down.
    layers: Vec<Layer>,
    /// Heights of the upper edges of the latter [m].
    tops: Vec<f64>,
    processor: Arch,
}

/// The sums last taken.
#[derive(Debug)]
struct Memory {
    moment: u64,
    time: f64,
    /// This time in the slots of every layer.
    now: Vec<Now>,
    /// Real and imaginary R_q.
    regions: Shelf<[[f64; NODES]; 2]>,
    /// Real and imaginary S_j, of the waves and of what the bed sends back.
    sums: Shelf<[[f64; STAND]; 4]>,
    motions: Shelf<[f64; MOTION]>,
    swells: Shelf<[f64; SWELL]>,
    /// Room for cos and sin of all components.
    angles: [Vec<f64>; 2],
}

impl Near {
    /// The components, longest first, or none where summing them one by one is better: they are few, or so short that a line would pass
    /// through many cells in each of them.
    pub fn new(members: &[Member], water: Water) -> Option<Near> {
        if members.len() < LEAST {
            return None;
        }
        let row = |of: fn(&Member) -> f64| {
            let mut row = vec![0.0; padded(members.len()) + MOST_LANES];
            row.iter_mut().zip(members).for_each(|(turns, member)| *turns = of(member) / TAU);
            row
        };
        let region = Region::new(members, &water);
        let nodes = region.as_ref().map(|region| &region.nodes[..]);
        let mut layers = vec![Layer::of_elevations(members, nodes, &water)];
        let mut tops = Vec::new();
        let mut top = 0.0;
        while let Some(layer) = Layer::of_velocities(members, nodes, &water, top).filter(|_| top > -water.depth) {
            if layer.half < SMALLEST * water.height {
                return None;
            }
            tops.push(top);
            top -= 2.0 * layer.half;
            layers.push(layer);
        }
        let (sin, cos) = water.direction.sin_cos();
        let turns = [row(|m| m.number), row(|m| m.omega), row(|m| m.phase)];
        let plan = Arc::new(Plan { water, cos, sin, turns, region, layers, tops, processor: Arch::new() });
        let memory = Mutex::new(Memory::new(&plan));
        (plan.layers.len() > 1).then_some(Near { plan, memory })
    }

    /// Σ a cos θ at a place [m].
    pub fn elevation(&self, time: f64, x: f64, y: f64) -> f64 {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        self.plan.processor.dispatch(Elevation { plan: &self.plan, memory: &mut memory, time, along: self.plan.along(x, y) })
    }

    /// Sums of the velocities [m/s] and accelerations [m/s²] at `count` places (rows x, y, z [m]), all of them eased by `easing`
    /// in the elevation alone.
    pub fn sums(&self, count: usize, time: f64, easing: f64, places: &[[f64; MOST_LANES]; 3]) -> [[f64; MOST_LANES]; 6] {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        self.plan.processor.dispatch(Sums { plan: &self.plan, memory: &mut memory, count, time, easing, places })
    }

    /// The layers of cells: of elevations, and of velocities from the surface down.
    pub fn layers(&self) -> &[Layer] {
        &self.plan.layers
    }

    /// cos b and sin b of the direction b of travel.
    pub fn direction(&self) -> [f64; 2] {
        [self.plan.cos, self.plan.sin]
    }

    /// Which of the layers a height is in [m]; none below the last.
    pub fn layer_at(&self, z: f64) -> Option<usize> {
        let layer = self.plan.layer_at(z);
        let of = &self.plan.layers[layer];
        (z - of.middle >= -of.half).then_some(layer)
    }

    /// Writes the polynomial of the elevation in a cell, a column of its layer, and the slot of a time [s] into one lane of rows.
    #[inline(never)]
    pub fn put_swell(&self, time: f64, column: i64, rows: &mut [[f64; MOST_LANES]; SWELL], lane: usize) {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        let at = self.plan.processor.dispatch(Swell { plan: &self.plan, memory: &mut memory, time, column });
        rows.iter_mut().zip(&memory.swells.things[at]).for_each(|(row, number)| row[lane] = *number);
    }

    /// Writes the polynomial of the velocity in a cell, a column of a layer, and the slot of a time [s] into one lane of rows.
    #[inline(never)]
    pub fn put_motion(&self, time: f64, layer: usize, column: i64, rows: &mut [[f64; MOST_LANES]; MOTION], lane: usize) {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        let at = self.plan.processor.dispatch(Velocity { plan: &self.plan, memory: &mut memory, time, layer, column });
        rows.iter_mut().zip(&memory.motions.things[at]).for_each(|(row, number)| row[lane] = *number);
    }

    /// Adds the sums of velocities and accelerations at levels that are known already, below places in rows x and y [m].
    pub fn add_motions(
        &self,
        time: f64,
        places: &[[f64; MOST_LANES]; 3],
        levels: &[Level<f64>],
        to: &mut [[f64; MOST_LANES]; 6],
    ) {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        self.plan.processor.dispatch(Motions { plan: &self.plan, memory: &mut memory, time, places, levels, to });
    }
}

impl Plan {
    fn along(&self, x: f64, y: f64) -> f64 {
        x * self.cos + y * self.sin
    }

    /// The last layer whose upper edge is not below z; the first is that of elevations.
    #[inline(always)]
    fn layer_at(&self, z: f64) -> usize {
        self.tops.partition_point(|top| *top >= z).max(1)
    }
}

/// A time within a slot of a layer.
#[derive(Debug, Clone, Copy)]
pub struct Now {
    /// Number of the slot.
    pub slot: i64,
    /// Time from the middle of the slot, by half a slot, from -1 to 1.
    pub share: f64,
}

impl Now {
    /// A time [s] in the slots of a layer.
    pub fn new(layer: &Layer, time: f64) -> Now {
        let slot = (time / layer.slot).floor();
        Now { slot: slot as i64, share: (time - (slot + 0.5) * layer.slot) * (2.0 / layer.slot) }
    }
}

/// A place within a cell.
struct Within {
    layer: usize,
    /// Number of the cell, with that of its layer.
    cell: i64,
    /// The middle of the cell along the direction of travel, and the distance from there [m].
    middle: f64,
    off: f64,
}

impl Within {
    #[inline(always)]
    fn new(plan: &Plan, layer: usize, along: f64) -> Within {
        let within = Within::column(plan, layer, (along * plan.layers[layer].per_width).round_ties_even());
        Within { off: along - within.middle, ..within }
    }

    /// The middle of a cell.
    #[inline(always)]
    fn column(plan: &Plan, layer: usize, column: f64) -> Within {
        let middle = column * (2.0 * plan.layers[layer].half);
        Within { layer, cell: ((column as i64) << 16) + layer as i64, middle, off: 0.0 }
    }
}

impl Memory {
    fn new(plan: &Plan) -> Memory {
        let room = plan.turns[0].len();
        Memory {
            moment: RECENT,
            time: f64::NAN,
            now: vec![Now { slot: 0, share: 0.0 }; plan.layers.len()],
            regions: Shelf::new([[0.0; NODES]; 2], FEW),
            sums: Shelf::new([[0.0; STAND]; 4], MANY),
            motions: Shelf::new([0.0; MOTION], MANY),
            swells: Shelf::new([0.0; SWELL], MANY),
            angles: [vec![0.0; room], vec![0.0; room]],
        }
    }

    #[inline(always)]
    fn tick(&mut self, plan: &Plan, time: f64) {
        if time != self.time {
            (self.time, self.moment) = (time, self.moment + 1);
            self.now.iter_mut().zip(&plan.layers).for_each(|(now, layer)| *now = Now::new(layer, time));
        }
    }

    /// The sums of a cell and the span of a slot, and the number of the slot in it.
    #[inline(always)]
    fn sums<V: Simd>(&mut self, cpu: V, plan: &Plan, within: &Within, slot: i64) -> (&[[f64; STAND]; 4], usize) {
        let of = &plan.layers[within.layer];
        let (span, slot) = (slot.div_euclid(of.slots), slot.rem_euclid(of.slots));
        let (at, missing) = self.sums.place((within.cell, span), self.moment);
        if missing {
            let midst = (span as f64 + 0.5) * of.slots as f64 * of.slot;
            self.sums.things[at] = match &plan.region {
                None => of.sums(cpu, &plan.turns, None, &mut self.angles, [within.middle, midst]),
                Some(region) => {
                    let key = region.at(within.middle, midst);
                    let [along, time] = region.middle(key);
                    let (known, missing) = self.regions.place(key, self.moment);
                    if missing {
                        self.regions.things[known] = region.sums(cpu, &plan.turns, &mut self.angles, [along, time]);
                    }
                    let [re, im] = &self.regions.things[known];
                    of.sums(cpu, &region.turns, Some([re, im]), &mut self.angles, [within.middle - along, midst - time])
                }
            };
        }
        (&self.sums.things[at], slot as usize)
    }

    /// Where the polynomial of the elevation in a cell and a slot is kept.
    #[inline(always)]
    fn swell<V: Simd>(&mut self, cpu: V, plan: &Plan, within: &Within, slot: i64) -> usize {
        let (at, missing) = self.swells.place((within.cell, slot), self.moment);
        if missing {
            let mut swell = [0.0; SWELL];
            let (sums, slot) = self.sums(cpu, plan, within, slot);
            plan.layers[0].swell(cpu, sums, slot, &mut swell);
            self.swells.things[at] = swell;
        }
        at
    }

    /// Where the polynomial of the velocity in a cell and a slot is kept.
    #[inline(always)]
    fn velocity<V: Simd>(&mut self, cpu: V, plan: &Plan, within: &Within, slot: i64) -> usize {
        let (at, missing) = self.motions.place((within.cell, slot), self.moment);
        if missing {
            let mut motion = [0.0; MOTION];
            let (sums, slot) = self.sums(cpu, plan, within, slot);
            plan.layers[within.layer].motion(cpu, sums, slot, &mut motion);
            self.motions.things[at] = motion;
        }
        at
    }

    /// Σ a cos θ [m].
    #[inline(always)]
    fn elevation<V: Simd>(&mut self, cpu: V, plan: &Plan, along: f64, time: f64) -> f64 {
        self.tick(plan, time);
        let (within, now) = (Within::new(plan, 0, along), self.now[0]);
        let at = self.swell(cpu, plan, &within, now.slot);
        let (swell, mut terms) = (&self.swells.things[at], [0.0; TERMS]);
        for lane in (0..TERMS).step_by(V::F64_LANES) {
            let share = Lanes::<V>::splat(cpu, now.share);
            let mut sum = Lanes::<V>::load(cpu, swell, (POWERS - 1) * TERMS + lane);
            for n in (0..POWERS - 1).rev() {
                sum = sum.mul_add(share, Lanes::load(cpu, swell, n * TERMS + lane));
            }
            sum.store(&mut terms, lane);
        }
        let (x, xx) = (within.off, within.off * within.off);
        let half = |first: usize| {
            let [a, b, c, d] = [terms[first], terms[first + 2], terms[first + 4], terms[first + 6]];
            d.mul_add(xx, c).mul_add(xx, b).mul_add(xx, a)
        };
        half(1).mul_add(x, half(0))
    }

    /// The series of the velocity and of its rate [1/s] in a layer now: real and imaginary factors of ζ^m of each, and how far off the middle it is.
    #[inline(always)]
    fn series<V: Simd>(&mut self, cpu: V, plan: &Plan, layer: usize, along: f64, time: f64) -> ([[f64; 2 * TERMS]; 2], f64) {
        self.tick(plan, time);
        let (within, now) = (Within::new(plan, layer, along), self.now[layer]);
        let of = &plan.layers[layer];
        let at = self.velocity(cpu, plan, &within, now.slot);
        let (motion, mut series) = (&self.motions.things[at], [[0.0; 2 * TERMS]; 2]);
        let [values, rates] = &mut series;
        for lane in (0..2 * TERMS).step_by(V::F64_LANES) {
            let share = Lanes::<V>::splat(cpu, now.share);
            let term = |n: usize| Lanes::<V>::load(cpu, motion, n * 2 * TERMS + lane);
            let mut rate = term(POWERS - 1);
            let mut sum = rate.mul_add(share, term(POWERS - 2));
            for n in (0..POWERS - 2).rev() {
                rate = rate.mul_add(share, sum);
                sum = sum.mul_add(share, term(n));
            }
            sum.store(values, lane);
            (rate * (2.0 / of.slot)).store(rates, lane);
        }
        (series, within.off)
    }

    /// u, w, ∂u/∂t and ∂w/∂t at a level.
    #[inline(always)]
    fn motion_at<V: Simd>(&mut self, cpu: V, plan: &Plan, along: f64, level: &Level<f64>, time: f64) -> [f64; 4] {
        let mut motion = self.motion(cpu, plan, along, level.z, time);
        if level.above > 0.0 {
            // The slope at still water: Σ m c_m ζ^(m-1), ζ = z + ix from the middle of the cell.
            let up = level.z - plan.layers[1].middle;
            let (series, off) = self.series(cpu, plan, 1, along, time);
            for (c, of) in series.iter().enumerate() {
                let (mut u, mut w) = (0.0, 0.0);
                for m in (1..TERMS).rev() {
                    let turned = (u * up - w * off, w * up + u * off);
                    (u, w) = ((m as f64).mul_add(of[m], turned.0), (m as f64).mul_add(of[TERMS + m], turned.1));
                }
                motion[2 * c] += level.above * u;
                motion[2 * c + 1] += level.above * w;
            }
        }
        motion.map(|of| level.share * of)
    }

    /// u, w, ∂u/∂t and ∂w/∂t at z′ [m].
    #[inline(always)]
    fn motion<V: Simd>(&mut self, cpu: V, plan: &Plan, along: f64, z: f64, time: f64) -> [f64; 4] {
        let layer = plan.layer_at(z);
        let of = &plan.layers[layer];
        let up = z - of.middle;
        if up < -of.half {
            return [0.0; 4];
        }
        let ([values, rates], off) = self.series(cpu, plan, layer, along, time);
        // Terms of even and of odd order side by side, by powers of ζ².
        let (re, im) = (up * up - off * off, 2.0 * up * off);
        let sum = |series: &[f64; 2 * TERMS]| {
            let mut sums = [0.0; 4];
            for m in (0..TERMS).step_by(2).rev() {
                for (c, last) in [(0, [sums[0], sums[1]]), (2, [sums[2], sums[3]])] {
                    let at = m + c / 2;
                    sums[c] = last[0].mul_add(re, last[1].mul_add(-im, series[at]));
                    sums[c + 1] = last[1].mul_add(re, last[0].mul_add(im, series[TERMS + at]));
                }
            }
            let [u, w, odd_u, odd_w] = sums;
            [odd_u.mul_add(up, odd_w.mul_add(-off, u)), odd_w.mul_add(up, odd_u.mul_add(off, w))]
        };
        let ([u, w], [du, dw]) = (sum(&values), sum(&rates));
        [u, w, du, dw]
    }
}

/// `Near::sums` in the instructions of the processor.
struct Sums<'a> {
    plan: &'a Plan,
    memory: &'a mut Memory,
    count: usize,
    time: f64,
    easing: f64,
    places: &'a [[f64; MOST_LANES]; 3],
}

impl WithSimd for Sums<'_> {
    type Output = [[f64; MOST_LANES]; 6];

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> Self::Output {
        let Sums { plan, memory, count, time, easing, places: [x, y, z] } = self;
        let (deep, shallowest) = (plan.water.depth, SHALLOWEST * plan.water.depth);
        let mut rows = [[0.0; MOST_LANES]; 6];
        for lane in 0..count {
            // Lanes that are left over repeat a place.
            if lane > 0 && [x, y, z].iter().all(|row| row[lane] == row[lane - 1]) {
                rows.iter_mut().for_each(|row| row[lane] = row[lane - 1]);
                continue;
            }
            let along = plan.along(x[lane], y[lane]);
            let elevation = easing * memory.elevation(cpu, plan, along, time);
            let [u, w, du, dw] = if plan.water.stretching == Stretching::Wheeler {
                let depth = (deep + elevation).max(shallowest);
                let level = ((z[lane] + deep) * deep / depth - deep).min(0.0).max(-deep);
                memory.motion(cpu, plan, along, level, time)
            } else {
                let level = plan.water.stretching.level((), z[lane], elevation, deep);
                memory.motion_at(cpu, plan, along, &level, time)
            };
            let all = [u * plan.cos, u * plan.sin, w, du * plan.cos, du * plan.sin, dw];
            rows.iter_mut().zip(all).for_each(|(row, number)| row[lane] = number);
        }
        rows
    }
}

/// `Near::add_motions` in the instructions of the processor.
struct Motions<'a> {
    plan: &'a Plan,
    memory: &'a mut Memory,
    time: f64,
    places: &'a [[f64; MOST_LANES]; 3],
    levels: &'a [Level<f64>],
    to: &'a mut [[f64; MOST_LANES]; 6],
}

impl WithSimd for Motions<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        let Motions { plan, memory, time, places: [x, y, _], levels, to } = self;
        for (lane, level) in levels.iter().enumerate() {
            let [u, w, du, dw] = memory.motion_at(cpu, plan, plan.along(x[lane], y[lane]), level, time);
            let all = [u * plan.cos, u * plan.sin, w, du * plan.cos, du * plan.sin, dw];
            to.iter_mut().zip(all).for_each(|(row, number)| row[lane] += number);
        }
    }
}

/// `Near::elevation` in the instructions of the processor.
struct Elevation<'a> {
    plan: &'a Plan,
    memory: &'a mut Memory,
    time: f64,
    along: f64,
}

impl WithSimd for Elevation<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> f64 {
        self.memory.elevation(cpu, self.plan, self.along, self.time)
    }
}

/// `Near::put_swell` in the instructions of the processor.
struct Swell<'a> {
    plan: &'a Plan,
    memory: &'a mut Memory,
    time: f64,
    column: i64,
}

impl WithSimd for Swell<'_> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> usize {
        let Swell { plan, memory, time, column } = self;
        memory.tick(plan, time);
        memory.swell(cpu, plan, &Within::column(plan, 0, column as f64), memory.now[0].slot)
    }
}

/// `Near::put_motion` in the instructions of the processor.
struct Velocity<'a> {
    plan: &'a Plan,
    memory: &'a mut Memory,
    time: f64,
    layer: usize,
    column: i64,
}

impl WithSimd for Velocity<'_> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> usize {
        let Velocity { plan, memory, time, layer, column } = self;
        memory.tick(plan, time);
        memory.velocity(cpu, plan, &Within::column(plan, layer, column as f64), memory.now[layer].slot)
    }
}
