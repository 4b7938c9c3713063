//! Many waves of one direction, near a place and for a while: sixteen waves that stand for all of them.
//!
//! ```text
//! Σ B e^(i(kδ - ωτ)) = Σ_j S_j e^(i(k_j δ - ω_j τ)),   S_j = Σ B L_j(ω)                       near a place, for a while
//!                    = Σ_m c_m (iδ)^m,                 c_m = Σ_j S_j e^(-i ω_j τ) k_j^m / m!    near a place, now
//! ```
//!
//! B complex amplitude of a component at the middle of a cell of space and of a span of time, δ and τ place and time from there,
//! ω_j Chebyshev's points between the lowest and the highest frequency, L_j Lagrange's polynomials through them, k_j = k(ω_j). As a function
//! of ω, e^(i(kδ - ωτ)) is a polynomial of degree 15 to within 1e-6 as long as δ and τ are small enough; so the sums over
//! components are taken once for a cell and a span, those over j once for a cell and a time, and a point of the line costs ten terms.
//!
//! Velocities of a plane flow are analytic: u + iw = Σ B e^(ikδ) + Σ B′* e^(-ikδ), δ = x - iz from the middle, B′ what the bed sends back.
//! The deeper a cell, the fewer components reach it, and the larger it is. Elevations have cells of their own, on z = 0.
//!
//! All numbers kept are functions of cell, span and time alone: whatever was asked for before, and whatever had to make room,
//! answers have the same bits.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::scene::types::Stretching;
use crate::sea::series::cos_sin;
use crate::sea::stretching::{Level, SHALLOWEST};
use crate::sea::wave::wave_number;
use pulp::{Arch, Simd, WithSimd};
use std::f64::consts::{PI, TAU};
use std::sync::{Arc, Mutex, PoisonError};

/// Waves that stand for all.
const STAND: usize = 16;
/// Terms in space.
const TERMS: usize = 10;
/// Half a span of time times half the band of frequencies, at most [-].
const WHILE: f64 = 3.6;
/// Distance from the middle of a cell times the largest wave number, at most [-].
const AWAY: f64 = 1.6;
/// Half the height of a cell is at least this share of the depth of its upper edge.
const SHARE: f64 = 0.2;
/// Components are left out of cells where e^(kz) is below e^-this.
const REACH: f64 = 11.5;
/// Cells near the surface must have at least this share of the significant wave height, or a line would leave them too often.
const SMALLEST: f64 = 0.05;
/// Fewer components are summed one by one.
const LEAST: usize = 32;
/// Cells kept at first, and at most; each takes a kilobyte.
const ROOM: [usize; 2] = [256, 16_384];
/// Numbers of a series of velocities, four a term; one of elevations has one a term.
const SERIES: usize = 4 * TERMS;
/// Numbers of a series that belong to one j, or repeat for it.
const PATTERN: usize = 8;
/// Places at which a cell may be kept.
const PROBES: usize = 8;
/// Cells asked for within this many moments do not make room; the memory grows instead.
const RECENT: u64 = 8;
/// A band of frequencies is at least this share of its highest.
const NARROWEST: f64 = 1.0e-3;

/// A component, as `Near` is built from.
#[derive(Debug, Clone, Copy)]
pub struct Member {
    /// k [1/m].
    pub number: f64,
    /// ω [rad/s].
    pub omega: f64,
    /// φ [rad].
    pub phase: f64,
    /// a [m].
    pub amplitude: f64,
    /// a ω / (1 - e^(-2kd)) [m/s].
    pub speed: f64,
    /// Whether the bed sends anything back.
    pub echoes: bool,
}

/// The sea in which the components travel.
#[derive(Debug, Clone, Copy)]
pub struct Water {
    /// g [m/s²].
    pub gravity: f64,
    /// d [m].
    pub depth: f64,
    /// Significant wave height [m].
    pub height: f64,
    /// Direction of travel, from +x towards +y [rad].
    pub direction: f64,
    /// How motions are carried to the surface.
    pub stretching: Stretching,
}

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
    /// Duration of a span of time [s].
    span: f64,
    /// k/2π, ω/2π and φ/2π.
    turns: [Vec<f64>; 3],
    /// The layer of elevations, and those of velocities from the surface down.
    layers: Vec<Layer>,
    /// Heights of the upper edges of the latter [m].
    tops: Vec<f64>,
    processor: Arch,
}

/// Cells of one height.
#[derive(Debug)]
struct Layer {
    /// Height of the middle [m].
    middle: f64,
    /// Half the width and half the height of a cell [m].
    half: f64,
    /// ω_j/2π [1/s].
    frequency: [f64; STAND],
    /// ω_j [rad/s].
    omega: [f64; STAND],
    /// k_j^m/m! for every j in the order of a series, and how many there are for one j.
    powers: Vec<f64>,
    width: usize,
    /// L_j(ω) of the components that reach here.
    shares: Vec<[f64; STAND]>,
    /// |B| and |B′|; the latter empty where the bed sends nothing back.
    down: Vec<f64>,
    back: Vec<f64>,
}

/// A cell of space and a span of time.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Key {
    layer: usize,
    column: f64,
    span: f64,
}

impl Key {
    /// Where the search for it begins among 2^n places.
    fn place(&self, count: usize) -> usize {
        let mixed = (self.column as i64 as u64)
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
            .wrapping_add((self.span as i64 as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
            .wrapping_add((self.layer as u64).wrapping_mul(0x1656_67b1_9e37_79f9));
        ((mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32) as usize & (count - 1)
    }
}

/// The sums of a cell.
#[derive(Debug, Clone)]
struct Cell {
    key: Key,
    /// The moment at which it was last asked for.
    used: u64,
    /// The time of `series` [s].
    time: f64,
    /// Real and imaginary S_j, of the waves and of what the bed sends back.
    sums: [[f64; STAND]; 4],
    /// c_m of the velocity and of the acceleration, real and imaginary; of an elevation, the factors of δ^m.
    series: [f64; SERIES],
}

/// The sums last taken.
#[derive(Debug)]
struct Memory {
    cells: Vec<Cell>,
    moment: u64,
    time: f64,
    /// cos ω_j τ and sin ω_j τ of every layer, with their times.
    phasors: Vec<(f64, [f64; STAND], [f64; STAND])>,
    /// Room for cos and sin of all components.
    angles: [Vec<f64>; 2],
}

impl Near {
    /// The components, longest first, or none where summing them one by one is better: they are few, or so short that a line would pass
    /// through many cells in each of them.
    pub fn new(members: &[Member], water: Water) -> Option<Near> {
        let (first, last) = (members.first()?, members.last()?);
        let half = AWAY / (last.number * 2.0f64.sqrt());
        if members.len() < LEAST || half < SMALLEST * water.height {
            return None;
        }
        let band = 0.5 * (last.omega - first.omega).max(NARROWEST * last.omega);
        let row = |of: fn(&Member) -> f64| {
            let mut row = vec![0.0; padded(members.len()) + MOST_LANES];
            row.iter_mut().zip(members).for_each(|(turns, member)| *turns = of(member) / TAU);
            row
        };
        let mut layers = vec![Layer::new(members, &water, true, 0.0, AWAY / last.number, |member| (member.amplitude, 0.0))];
        let mut tops = Vec::new();
        let lowest = -water.depth.min(REACH / first.number);
        let mut top = 0.0;
        while top > lowest {
            let half = half.max(-SHARE * top);
            let reached = members.partition_point(|member| -member.number * top < REACH).max(1);
            let middle = top - half;
            let moved = |member: &Member| {
                let down = member.speed * (member.number * middle).exp();
                let back = member.speed * (-member.number * (2.0 * water.depth + middle)).exp();
                (down, if member.echoes { back } else { 0.0 })
            };
            layers.push(Layer::new(&members[..reached], &water, false, middle, half, moved));
            tops.push(top);
            top -= 2.0 * half;
        }
        let (sin, cos) = water.direction.sin_cos();
        let plan = Arc::new(Plan {
            water,
            cos,
            sin,
            span: 2.0 * WHILE / band,
            turns: [row(|m| m.number), row(|m| m.omega), row(|m| m.phase)],
            layers,
            tops,
            processor: Arch::new(),
        });
        let memory = Mutex::new(Memory::new(&plan));
        Some(Near { plan, memory })
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
}

impl Layer {
    fn new(
        members: &[Member],
        water: &Water,
        level: bool,
        middle: f64,
        half: f64,
        moved: impl Fn(&Member) -> (f64, f64),
    ) -> Layer {
        let highest = members.last().map_or(1.0, |member| member.omega);
        let lowest = members.first().map_or(0.0, |member| member.omega).min((1.0 - NARROWEST) * highest);
        let (centre, band) = (0.5 * (highest + lowest), 0.5 * (highest - lowest));
        let turn: [f64; STAND] = std::array::from_fn(|j| (2 * j + 1) as f64 * PI / (2 * STAND) as f64);
        let omega = turn.map(|turn| centre + band * turn.cos());
        let number = omega.map(|omega| wave_number(omega, water.gravity, water.depth));
        let (each, width) = if level { (1, TERMS.next_multiple_of(PATTERN)) } else { (4, SERIES) };
        let mut powers = vec![0.0; STAND * width + MOST_LANES];
        for (row, number) in powers.chunks_exact_mut(width).zip(number) {
            let mut power = 1.0;
            for (m, terms) in row.chunks_exact_mut(each).take(TERMS).enumerate() {
                power *= if m > 0 { number / m as f64 } else { 1.0 };
                terms.fill(power);
            }
        }
        let shares = |member: &Member| {
            if let Some(at) = omega.iter().position(|omega| *omega == member.omega) {
                return std::array::from_fn(|j| f64::from(u8::from(j == at)));
            }
            // Barycentric form at Chebyshev's points of the first kind.
            let pull: [f64; STAND] = std::array::from_fn(|j| {
                let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
                sign * turn[j].sin() * band / (member.omega - omega[j])
            });
            let total: f64 = pull.iter().sum();
            pull.map(|pull| pull / total)
        };
        let (down, back): (Vec<f64>, Vec<f64>) = members.iter().map(moved).unzip();
        let back = if back.iter().any(|back| *back > 0.0) { back } else { Vec::new() };
        Layer {
            middle,
            half,
            frequency: omega.map(|omega| omega / TAU),
            omega,
            powers,
            width,
            shares: members.iter().map(shares).collect(),
            down,
            back,
        }
    }

    /// S_j for a cell and a span about `time` [s], at `along` [m].
    #[inline(always)]
    fn sums<V: Simd>(
        &self,
        cpu: V,
        turns: &[Vec<f64>; 3],
        angles: &mut [Vec<f64>; 2],
        along: f64,
        time: f64,
    ) -> [[f64; STAND]; 4] {
        let [numbers, frequencies, phases] = turns;
        let [cosines, sines] = angles;
        for n in (0..self.down.len()).step_by(V::F64_LANES) {
            let load = |row: &[f64]| Lanes::<V>::load(cpu, row, n);
            let (cos, sin) = cos_sin(cpu, load(numbers).scale_add(along, load(frequencies).scale_add(-time, load(phases))));
            cos.store(cosines, n);
            sin.store(sines, n);
        }
        let mut sums = [[0.0; STAND]; 4];
        for ((shares, down), (cos, sin)) in self.shares.iter().zip(&self.down).zip(cosines.iter().zip(sines.iter())) {
            let (re, im) = (cos * down, sin * down);
            for j in 0..STAND {
                sums[0][j] = shares[j].mul_add(re, sums[0][j]);
                sums[1][j] = shares[j].mul_add(im, sums[1][j]);
            }
        }
        for ((shares, back), (cos, sin)) in self.shares.iter().zip(&self.back).zip(cosines.iter().zip(sines.iter())) {
            let (re, im) = (cos * back, sin * back);
            for j in 0..STAND {
                sums[2][j] = shares[j].mul_add(re, sums[2][j]);
                sums[3][j] = shares[j].mul_add(im, sums[3][j]);
            }
        }
        sums
    }

    /// c_m from S_j and the phasors of a time.
    #[inline(always)]
    fn series<V: Simd>(&self, cpu: V, sums: &[[f64; STAND]; 4], cos: &[f64; STAND], sin: &[f64; STAND]) -> [f64; SERIES] {
        let mut patterns = [0.0; STAND * PATTERN];
        for (j, pattern) in patterns.chunks_exact_mut(PATTERN).enumerate() {
            // S e^(-iωτ), and its rate, -iω times that; of what the bed sends back, the conjugates.
            let turned = |re: f64, im: f64| (re * cos[j] + im * sin[j], im * cos[j] - re * sin[j]);
            let (re, im) = turned(sums[0][j], sums[1][j]);
            if self.width < SERIES {
                // Re S i^m.
                pattern.copy_from_slice(&[re, -im, -re, im, re, -im, -re, im]);
                continue;
            }
            let down = [re, im, self.omega[j] * im, -self.omega[j] * re];
            let (re, im) = turned(sums[2][j], sums[3][j]);
            let back = [re, -im, self.omega[j] * im, self.omega[j] * re];
            for c in 0..4 {
                (pattern[c], pattern[4 + c]) = (down[c] + back[c], down[c] - back[c]);
            }
        }
        let mut series = [0.0; SERIES];
        for at in (0..self.width).step_by(V::F64_LANES) {
            let mut sum = Lanes::<V>::splat(cpu, 0.0);
            for j in 0..STAND {
                let power = Lanes::<V>::load(cpu, &self.powers, j * self.width + at);
                sum = power.mul_add(Lanes::<V>::load(cpu, &patterns, j * PATTERN + at % PATTERN), sum);
            }
            sum.store(&mut series, at);
        }
        series
    }
}

impl Memory {
    fn new(plan: &Plan) -> Memory {
        let room = plan.turns[0].len();
        Memory {
            cells: vec![Cell::empty(); ROOM[0]],
            moment: RECENT,
            time: f64::NAN,
            phasors: vec![(f64::NAN, [0.0; STAND], [0.0; STAND]); plan.layers.len()],
            angles: [vec![0.0; room], vec![0.0; room]],
        }
    }

    /// The series of the cell of a layer about `along` at a time, and the distance from its middle along the direction of travel [m].
    #[inline(always)]
    fn series<V: Simd>(&mut self, cpu: V, plan: &Plan, layer: usize, along: f64, time: f64) -> (&[f64; SERIES], f64) {
        if time != self.time {
            (self.time, self.moment) = (time, self.moment + 1);
        }
        let of = &plan.layers[layer];
        let column = (along / (2.0 * of.half)).round();
        let span = (time / plan.span).round();
        let (middle, midst) = (column * 2.0 * of.half, span * plan.span);
        let at = self.place(cpu, plan, Key { layer, column, span }, middle, midst);
        let cell = &mut self.cells[at];
        cell.used = self.moment;
        if cell.time != time {
            cell.time = time;
            let (when, cos, sin) = &mut self.phasors[layer];
            if *when != time {
                *when = time;
                for j in (0..STAND).step_by(V::F64_LANES) {
                    let (c, s) = cos_sin(cpu, Lanes::<V>::load(cpu, &of.frequency, j) * (time - midst));
                    c.store(cos, j);
                    s.store(sin, j);
                }
            }
            cell.series = of.series(cpu, &cell.sums, cos, sin);
        }
        (&cell.series, along - middle)
    }

    /// Where a cell is kept, its sums taken if it was not.
    #[inline(always)]
    fn place<V: Simd>(&mut self, cpu: V, plan: &Plan, key: Key, along: f64, time: f64) -> usize {
        loop {
            let start = key.place(self.cells.len());
            let mut oldest = start;
            for probe in 0..PROBES {
                let at = (start + probe) & (self.cells.len() - 1);
                if self.cells[at].key == key {
                    return at;
                }
                if self.cells[at].used < self.cells[oldest].used {
                    oldest = at;
                }
            }
            if self.cells[oldest].used + RECENT > self.moment && self.cells.len() < ROOM[1] {
                self.cells = vec![Cell::empty(); 2 * self.cells.len()];
                continue;
            }
            let sums = plan.layers[key.layer].sums(cpu, &plan.turns, &mut self.angles, along, time);
            self.cells[oldest] = Cell { key, used: self.moment, sums, ..Cell::empty() };
            return oldest;
        }
    }

    /// Σ a cos θ [m].
    #[inline(always)]
    fn elevation<V: Simd>(&mut self, cpu: V, plan: &Plan, along: f64, time: f64) -> f64 {
        let (series, off) = self.series(cpu, plan, 0, along, time);
        series[..TERMS].iter().rev().fold(0.0, |sum: f64, term| sum.mul_add(off, *term))
    }

    /// u, w, ∂u/∂t and ∂w/∂t at a level.
    #[inline(always)]
    fn motion_at<V: Simd>(&mut self, cpu: V, plan: &Plan, along: f64, level: &Level<f64>, time: f64) -> [f64; 4] {
        let mut motion = self.motion(cpu, plan, along, level.z, time);
        if level.above > 0.0 {
            // The slope at still water: Σ m c_m ζ^(m-1), ζ = z + ix from the middle of the cell.
            let up = level.z - plan.layers[1].middle;
            let (series, off) = self.series(cpu, plan, 1, along, time);
            let mut slope = [0.0; 4];
            for (m, terms) in series.chunks_exact(4).enumerate().skip(1).rev() {
                let [u, w, du, dw] = slope;
                let turned = [u * up - w * off, w * up + u * off, du * up - dw * off, dw * up + du * off];
                slope = std::array::from_fn(|c| (m as f64).mul_add(terms[c], turned[c]));
            }
            motion.iter_mut().zip(slope).for_each(|(of, slope)| *of += level.above * slope);
        }
        motion.map(|of| level.share * of)
    }

    /// u, w, ∂u/∂t and ∂w/∂t at z′ [m].
    #[inline(always)]
    fn motion<V: Simd>(&mut self, cpu: V, plan: &Plan, along: f64, z: f64, time: f64) -> [f64; 4] {
        // The last layer whose upper edge is not below z; the first is that of elevations.
        let layer = plan.tops.partition_point(|top| *top >= z).max(1);
        let of = &plan.layers[layer];
        let up = z - of.middle;
        if up < -of.half {
            return [0.0; 4];
        }
        let (series, off) = self.series(cpu, plan, layer, along, time);
        // Terms of even and of odd order side by side, by powers of (iδ)².
        let (re, im) = (up * up - off * off, 2.0 * up * off);
        let mut sum = [0.0; PATTERN];
        for terms in series.rchunks_exact(PATTERN) {
            let last = sum;
            for c in (0..PATTERN).step_by(2) {
                sum[c] = last[c].mul_add(re, last[c + 1].mul_add(-im, terms[c]));
                sum[c + 1] = last[c + 1].mul_add(re, last[c].mul_add(im, terms[c + 1]));
            }
        }
        let [even_u, even_w, even_du, even_dw, u, w, du, dw] = sum;
        [
            u.mul_add(up, w.mul_add(-off, even_u)),
            w.mul_add(up, u.mul_add(off, even_w)),
            du.mul_add(up, dw.mul_add(-off, even_du)),
            dw.mul_add(up, du.mul_add(off, even_dw)),
        ]
    }
}

impl Cell {
    fn empty() -> Cell {
        Cell {
            key: Key { layer: usize::MAX, column: 0.0, span: 0.0 },
            used: 0,
            time: f64::NAN,
            sums: [[0.0; STAND]; 4],
            series: [0.0; SERIES],
        }
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
