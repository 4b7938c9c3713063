//! Cells of one height: how large they are, and the sums over components that stand for the motion in each of them (the formulas in `near`).

use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real};
use crate::scene::types::Stretching;
use crate::sea::series::{DECAYED, cos_sin};
use crate::sea::wave::wave_number;
use pulp::Simd;
use std::f64::consts::PI;

/// Waves that stand for all.
pub const STAND: usize = 16;
/// Terms in space: those of one register of the widest processors.
pub const TERMS: usize = MOST_LANES;
/// Terms in time.
pub const POWERS: usize = 6;
/// Half a span of time times half the band of frequencies, at most [-].
const WHILE: f64 = 5.0;
/// Standard deviation of what a series in space or in time leaves out of the velocity, per that of the velocity at the surface [-].
const ERROR: f64 = 3.0e-6;
/// The same of the elevation, which is felt through the depth of a point alone.
const ERROR_OF_ELEVATION: f64 = 1.0e-5;
/// Distance of the corner of a cell from its middle times the largest wave number, at most [-].
const AWAY: f64 = 4.0;
/// Half a slot times the highest frequency, at most [-].
const BRIEF: f64 = 2.0;
/// Numbers of a polynomial of velocities: by power of time, real parts and imaginary parts.
pub const MOTION: usize = 2 * TERMS * POWERS;
/// Numbers of a polynomial of elevations.
pub const SWELL: usize = TERMS * POWERS;
/// Of waves that stand for others, those are left out that keep less than this share of the motion of the longest.
const FAINT: f64 = 1.0e-5;
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

impl Member {
    /// A component of k [1/m], ω [rad/s], phase [rad] and amplitude [m] in water of a depth [m].
    pub fn new(number: f64, omega: f64, phase: f64, amplitude: f64, depth: f64) -> Member {
        let echoes = number * depth < DECAYED;
        let speed = amplitude * omega / if echoes { -(-2.0 * number * depth).exp_m1() } else { 1.0 };
        Member { number, omega, phase, amplitude, speed, echoes }
    }
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

/// Cells of one height.
#[derive(Debug)]
pub struct Layer {
    /// Height of the middle [m].
    pub middle: f64,
    /// Half the width and half the height of a cell [m].
    pub half: f64,
    /// 1 over the width [1/m].
    pub per_width: f64,
    /// Duration of a slot [s].
    pub slot: f64,
    /// How many make a span.
    pub slots: i64,
    /// k_j^m/m!.
    terms: [[f64; TERMS]; STAND],
    /// Coefficients of s^n in cos (n even) and sin (n odd) of ω_j times half a slot times s, -1 ≤ s ≤ 1.
    rises: [[f64; POWERS]; STAND],
    /// cos ω_j τ and sin ω_j τ at the middles of the slots of a span.
    phasors: Vec<[[f64; STAND]; 2]>,
    /// L_j(ω) of the components that reach here, or of the waves that stand for them.
    shares: Vec<[f64; STAND]>,
    /// |B| and |B′|; the latter empty where the bed sends nothing back.
    down: Vec<f64>,
    back: Vec<f64>,
}

impl Layer {
    /// The cells of elevations, on z = 0, of at least one component.
    /// Sums are taken over `nodes` of unit amplitude, which stand for the components; without any, over the components.
    pub fn of_elevations(members: &[Member], nodes: Option<&[Member]>, water: &Water) -> Layer {
        let scale = size(members, |member| member.amplitude);
        let (last, error) = (members[members.len() - 1].number, ERROR_OF_ELEVATION * scale);
        let half = within(members, error, last, |member| member.amplitude);
        Layer::new(members, nodes, water, [0.0, half, error], |member| (member.amplitude, 0.0))
    }

    /// The layer below a height, or none where nothing reaches.
    pub fn of_velocities(members: &[Member], nodes: Option<&[Member]>, water: &Water, top: f64) -> Option<Layer> {
        let error = ERROR * size(members, |member| member.speed);
        // Both together are less than twice the first.
        let at = |z: f64| move |member: &Member| member.speed * (member.number * z).exp();
        let reached = reaching(members, error, at(top));
        let members = &members[..reached];
        let nodes = nodes.map(|nodes| {
            let least = FAINT * nodes.iter().map(at(top)).fold(0.0, f64::max);
            &nodes[..nodes.iter().rposition(|node| at(top)(node) >= least).map_or(0, |last| last + 1)]
        });
        let last = members.last()?.number.max(nodes.and_then(|nodes| nodes.last()).map_or(0.0, |node| node.number));
        let mut half = 0.0;
        for _ in 0..5 {
            half = within(members, error, last, at(top - half)) / 2.0f64.sqrt();
        }
        let middle = top - half;
        let moved = |member: &Member| {
            let back = member.speed * (-member.number * (2.0 * water.depth + middle)).exp();
            (at(middle)(member), if member.echoes { back } else { 0.0 })
        };
        Some(Layer::new(members, nodes, water, [middle, half, error], moved))
    }

    fn new(
        members: &[Member],
        nodes: Option<&[Member]>,
        water: &Water,
        [middle, half, error]: [f64; 3],
        moved: impl Fn(&Member) -> (f64, f64),
    ) -> Layer {
        let last = |members: &[Member]| members.last().map_or(0.0, |member| member.omega);
        let highest = last(members).max(last(nodes.unwrap_or(&[])));
        let lowest = members.first().map_or(0.0, |member| member.omega).min((1.0 - NARROWEST) * highest);
        let (centre, band) = (0.5 * (highest + lowest), 0.5 * (highest - lowest));
        let turn: [f64; STAND] = std::array::from_fn(|j| (2 * j + 1) as f64 * PI / (2 * STAND) as f64);
        let omega = turn.map(|turn| centre + band * turn.cos());
        let terms = omega.map(|omega| {
            let (number, mut power) = (wave_number(omega, water.gravity, water.depth), 1.0);
            std::array::from_fn(|m| {
                power *= if m > 0 { number / m as f64 } else { 1.0 };
                power
            })
        });
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
        let summed = nodes.unwrap_or(members);
        let (down, back): (Vec<f64>, Vec<f64>) = summed.iter().map(&moved).unzip();
        // Longest first: what is too short to come back is left out.
        let (mut left_out, amplitude) = (0.0, if nodes.is_some() { size(members, |member| member.amplitude) } else { 1.0 });
        let faint = back.iter().rev().take_while(|back| {
            left_out += (amplitude * **back).powi(2);
            left_out < error * error
        });
        let back = back[..back.len() - faint.count()].to_vec();
        // Interpolation at Chebyshev's points leaves out (ωs)^6/(6! 2^5).
        let sixth = 10.0 * size(members, |member| moved(member).0 * member.omega.powi(POWERS as i32)) / (720.0 * 32.0);
        let span = 2.0 * WHILE / band;
        let slot = (2.0 * (error / sixth).powf(1.0 / POWERS as f64)).min(2.0 * BRIEF / highest).min(span);
        let slots = (span / slot).floor().max(1.0) as i64;
        let phasors = (0..slots).map(|number| {
            let time = (number as f64 + 0.5 - 0.5 * slots as f64) * slot;
            [omega.map(|omega| (omega * time).cos()), omega.map(|omega| (omega * time).sin())]
        });
        Layer {
            middle,
            half,
            per_width: 0.5 / half,
            slot,
            slots,
            terms,
            rises: omega.map(|omega| rise(0.5 * slot * omega)),
            phasors: phasors.collect(),
            shares: summed.iter().map(shares).collect(),
            down,
            back,
        }
    }

    /// S_j for a cell and a span, `along` [m] and `time` [s] from where the waves that are summed have their phases; `turns`: their k/2π, ω/2π and φ/2π,
    /// `factors`: real and imaginary parts of their amplitudes, where they are not 1.
    #[inline(always)]
    pub fn sums<V: Simd>(
        &self,
        cpu: V,
        turns: &[Vec<f64>; 3],
        factors: Option<[&[f64]; 2]>,
        angles: &mut [Vec<f64>; 2],
        [along, time]: [f64; 2],
    ) -> [[f64; STAND]; 4] {
        let [numbers, frequencies, phases] = turns;
        let [cosines, sines] = angles;
        for n in (0..self.down.len()).step_by(V::F64_LANES) {
            let still = Lanes::<V>::load(cpu, frequencies, n).scale_add(-time, Lanes::load(cpu, phases, n));
            let (mut cos, mut sin) = cos_sin(cpu, Lanes::load(cpu, numbers, n).scale_add(along, still));
            if let Some([re, im]) = factors {
                let (re, im) = (Lanes::<V>::load(cpu, re, n), Lanes::<V>::load(cpu, im, n));
                (cos, sin) = (re * cos - im * sin, re * sin + im * cos);
            }
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

    /// c_mn of velocities in a slot of a span.
    #[inline(always)]
    pub fn motion<V: Simd>(&self, cpu: V, sums: &[[f64; STAND]; 4], slot: usize, to: &mut [f64; MOTION]) {
        let [re, im] = turned([&sums[0], &sums[1]], &self.phasors[slot]);
        let back = if self.back.is_empty() { None } else { Some(turned([&sums[2], &sums[3]], &self.phasors[slot])) };
        for at in (0..TERMS).step_by(V::F64_LANES) {
            let signs = Lanes::<V>::load(cpu, &[1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0], at);
            let mut sum = [Lanes::<V>::splat(cpu, 0.0); 2 * POWERS];
            for j in 0..STAND {
                let terms = Lanes::<V>::load(cpu, &self.terms[j], at);
                let (x, y) = (terms * re[j], terms * im[j]);
                // Real and imaginary part with cos, and with sin.
                let mut parts = [x, y, y, -x];
                if let Some([re, im]) = &back {
                    let terms = terms * signs;
                    let (x, y) = (terms * re[j], terms * im[j]);
                    parts = [parts[0] + x, parts[1] - y, parts[2] + y, parts[3] + x];
                }
                for (n, rise) in self.rises[j].iter().enumerate() {
                    let even = 2 * (n % 2);
                    sum[2 * n] = parts[even].scale_add(*rise, sum[2 * n]);
                    sum[2 * n + 1] = parts[even + 1].scale_add(*rise, sum[2 * n + 1]);
                }
            }
            sum.iter().enumerate().for_each(|(row, sum)| sum.store(to, row * TERMS + at));
        }
    }

    /// The same of elevations, by powers of x alone: Re i^m c_mn.
    #[inline(always)]
    pub fn swell<V: Simd>(&self, cpu: V, sums: &[[f64; STAND]; 4], slot: usize, to: &mut [f64; SWELL]) {
        let [re, im] = turned([&sums[0], &sums[1]], &self.phasors[slot]);
        for at in (0..TERMS).step_by(V::F64_LANES) {
            let real = Lanes::<V>::load(cpu, &[1.0, 0.0, -1.0, 0.0, 1.0, 0.0, -1.0, 0.0], at);
            let imaginary = Lanes::<V>::load(cpu, &[0.0, -1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0], at);
            let mut sum = [Lanes::<V>::splat(cpu, 0.0); POWERS];
            for j in 0..STAND {
                let terms = Lanes::<V>::load(cpu, &self.terms[j], at);
                let (real, imaginary) = (real * terms, imaginary * terms);
                let even = imaginary.scale_add(im[j], real * re[j]);
                let odd = imaginary.scale_add(-re[j], real * im[j]);
                for (n, rise) in self.rises[j].iter().enumerate() {
                    sum[n] = if n % 2 == 0 { even } else { odd }.scale_add(*rise, sum[n]);
                }
            }
            sum.iter().enumerate().for_each(|(row, sum)| sum.store(to, row * TERMS + at));
        }
    }
}

/// S_j e^(-iω_j τ).
#[inline(always)]
fn turned([re, im]: [&[f64; STAND]; 2], [cos, sin]: &[[f64; STAND]; 2]) -> [[f64; STAND]; 2] {
    [std::array::from_fn(|j| re[j] * cos[j] + im[j] * sin[j]), std::array::from_fn(|j| im[j] * cos[j] - re[j] * sin[j])]
}

/// Standard deviation of a sum of components, times √2.
fn size(members: &[Member], of: impl Fn(&Member) -> f64) -> f64 {
    members.iter().map(|member| of(member).powi(2)).sum::<f64>().sqrt()
}

/// How many components, longest first, have to be counted for an error of the sum.
fn reaching(members: &[Member], error: f64, of: impl Fn(&Member) -> f64) -> usize {
    let mut left_out = 0.0;
    let faint = members.iter().rev().take_while(|member| {
        left_out += of(member).powi(2);
        left_out < error * error
    });
    members.len() - faint.count()
}

/// Distance from its middle up to which a series of `TERMS` terms is good for an error, where the largest wave number is `last`.
fn within(members: &[Member], error: f64, last: f64, of: impl Fn(&Member) -> f64) -> f64 {
    let factorial: f64 = (1..=TERMS).map(|m| m as f64).product();
    let next = size(members, |member| of(member) * member.number.powi(TERMS as i32)) / factorial;
    (error / next).powf(1.0 / TERMS as f64).min(AWAY / last)
}

/// Coefficients of s^n in cos as (n even) and sin as (n odd) on [-1, 1], exact at Chebyshev's points.
fn rise(a: f64) -> [f64; POWERS] {
    let points: [f64; 3] = std::array::from_fn(|i| ((2 * i + 1) as f64 * PI / 12.0).cos());
    let squares = points.map(|x| x * x);
    let through = |values: [f64; 3]| {
        let [x, y, z] = squares;
        let (first, second) = ((values[1] - values[0]) / (y - x), (values[2] - values[1]) / (z - y));
        let third = (second - first) / (z - x);
        [values[0] - x * (first - third * y), first - third * (x + y), third]
    };
    let (cos, sin) = (through(points.map(|x| (a * x).cos())), through(points.map(|x| (a * x).sin() / x)));
    [cos[0], sin[0], cos[1], sin[1], cos[2], sin[2]]
}
