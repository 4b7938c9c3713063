//! The motion of the water at the Gauss points of a line: asked for at the first iteration of a stage, and again where a point has left its place.
//!
//! A stage begins where the line is expected, so that its iterations move a point by about the error of a step. As long as that is
//! less than `NEAR` of a mean wave's number, the water there is taken to move as it did where it was asked: the error is this share of its velocity
//! at most. Whatever was kept before the first iteration does not matter, so that the bits of a stage depend on the stage alone.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::algebra::shape::{SHAPES3, Shape};
use crate::algebra::triple::Triple;
use crate::rod::ends::Ends;
use crate::rod::motion::{Asking, Motion};
use crate::rod::surface::TAKEN_AT;
use crate::sea::beside::{Beside, Place};
use crate::sea::clock::Clock;
use crate::sea::waves::{Flow, Waves};
use pulp::{Arch, Simd, WithSimd};

/// Distance times wave number within which the water is not asked again [-].
const NEAR: f64 = 1.0e-3;

/// Motions of the water at three points of every element, and where they were asked for.
#[derive(Debug, Clone)]
pub struct Flows {
    elements: usize,
    /// Lengths of elements [m], and heights below which they are wet in whatever waves there may be [m].
    lengths: Vec<f64>,
    waterlines: Vec<f64>,
    /// 1 where an element is all wet in the waves as they are, else 0.
    wets: Vec<f64>,
    /// Where on an element its height above the waves is taken.
    taken: [Shape; 4],
    /// Numbers between the first points of all elements and the second.
    stride: usize,
    /// Places [m]; infinite where nothing was asked.
    asked: [Vec<f64>; 3],
    /// Velocities [m/s], then accelerations [m/s²].
    rows: [Vec<f64>; 6],
    /// What the points keep of the sea, where that pays.
    beside: Option<Beside>,
    processor: Arch,
}

impl Flows {
    /// Room for elements of lengths [m] and heights below which each is certainly wet [m].
    pub fn new(waves: &Waves, mut lengths: Vec<f64>, mut waterlines: Vec<f64>) -> Flows {
        let elements = lengths.len();
        let stride = padded(elements);
        lengths.resize(stride, 0.0);
        // What is behind the last is never wet.
        waterlines.resize(stride, f64::NEG_INFINITY);
        let row = |_| vec![0.0; SHAPES3.len() * stride];
        let wets = vec![0.0; stride];
        let taken = TAKEN_AT.map(Shape::at);
        let (asked, rows) = (std::array::from_fn(row), std::array::from_fn(row));
        let beside = Beside::new(waves, SHAPES3.len() * stride, TAKEN_AT.len() * stride);
        Flows { elements, lengths, waterlines, wets, taken, stride, asked, rows, beside, processor: Arch::new() }
    }

    /// Whether it is cheap to ask for all points.
    pub fn is_cheap(&self) -> bool {
        self.beside.is_some()
    }

    /// Asks for what is not known yet in the stage of a motion, or, `anew`, for all.
    pub fn update(&mut self, waves: &Waves, at: &Motion, anew: bool) {
        self.processor.dispatch(Update { flows: self, waves, at, first: anew || at.asking != Asking::Again });
    }

    /// 1 for each of the elements from `e` on that is all wet, else 0.
    #[inline(always)]
    pub fn wet<F: Real>(&self, cpu: F::Cpu, e: usize) -> F {
        F::load(cpu, &self.wets, e)
    }

    /// Whether element `e` may not be all wet.
    pub fn is_dry(&self, e: usize) -> bool {
        self.wets[e] == 0.0
    }

    /// The motions at point `g` of the elements from `e` on.
    #[inline(always)]
    pub fn get<F: Real>(&self, cpu: F::Cpu, g: usize, e: usize) -> Flow<F> {
        let [vx, vy, vz, ax, ay, az] = &self.rows;
        let at = g * self.stride + e;
        Flow { velocity: Triple::load(cpu, [vx, vy, vz], at), acceleration: Triple::load(cpu, [ax, ay, az], at) }
    }
}

/// Points for which the water is asked together.
struct Questions {
    count: usize,
    places: [[f64; MOST_LANES]; 3],
    to: [usize; MOST_LANES],
}

impl Questions {
    fn put(&mut self, place: [f64; 3], to: usize) {
        self.places.iter_mut().zip(place).for_each(|(row, number)| row[self.count] = number);
        self.to[self.count] = to;
        self.count += 1;
    }

    /// Keeps the answers.
    fn answer(&mut self, flows: &mut Flows, waves: &Waves, at: &Motion) {
        let Some(last) = self.count.checked_sub(1) else { return };
        for row in &mut self.places {
            let repeated = row[last];
            row[self.count..].fill(repeated);
        }
        let answers = waves.motions(&at.clock, self.count, &self.places);
        for (lane, to) in self.to.iter().enumerate().take(self.count) {
            flows.rows.iter_mut().zip(&answers).for_each(|(row, answer)| row[*to] = answer[lane]);
        }
        self.count = 0;
    }
}

impl Flows {
    /// 1 where an element from `e` on is below the waves as they are, by the cubic through its height above them, else 0.
    #[inline(always)]
    fn wet_in<V: Simd>(&mut self, cpu: V, waves: &Waves, clock: Clock, e: usize, u: &Ends<Lanes<V>>) -> Lanes<V> {
        let waterline = Lanes::<V>::load(cpu, &self.waterlines, e);
        let wet = u.wet(waterline);
        let asked = (-wet + 1.0) * Lanes::load(cpu, &self.lengths, e).positive();
        let Some(beside) = self.beside.as_mut().filter(|_| asked.any_positive()) else { return wet };
        let mut h = [waterline; 4];
        let mut k = 0;
        while k < h.len() {
            let place = Place { clock, at: u.combine(&self.taken[k].value) };
            let first = (SHAPES3.len() + k) * self.stride + e;
            h[k] = place.at.z - beside.elevation(cpu, waves, first, &place, asked);
            k += 1;
        }
        let [a, b, c, d] = h;
        // Between the ends of an element the cubic lies below these.
        let near = (b * 18.0 - a * 5.0 - c * 9.0 + d * 2.0) * (1.0 / 6.0);
        let far = (c * 18.0 - d * 5.0 - b * 9.0 + a * 2.0) * (1.0 / 6.0);
        // Half a diameter below them.
        let under = waterline + waves.crest();
        wet.max((under - a.max(d).max(near).max(far)).step() * asked)
    }
}

/// `Flows::update` in the instructions of the processor.
struct Update<'a> {
    flows: &'a mut Flows,
    waves: &'a Waves,
    at: &'a Motion<'a>,
    first: bool,
}

impl WithSimd for Update<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        let Update { flows, waves, at, first } = self;
        let rows = at.u.rows();
        let (reach, floor) = (NEAR / waves.mean().1, waves.lowest_motion());
        let mut questions = Questions { count: 0, places: [[0.0; MOST_LANES]; 3], to: [0; MOST_LANES] };
        let one = Lanes::<V>::splat(cpu, 1.0);
        for e in (0..flows.elements).step_by(V::F64_LANES) {
            let u = Ends::load(cpu, &rows, e, Lanes::<V>::load(cpu, &flows.lengths, e));
            // Elements that are not all wet have points of their own.
            let wet = flows.wet_in(cpu, waves, at.clock, e, &u);
            wet.store(&mut flows.wets, e);
            for (g, shape) in SHAPES3.iter().enumerate() {
                let at_point = u.combine(&shape.value);
                let place = at_point.components(cpu);
                let from = g * flows.stride + e;
                let mut moved = one;
                if !first {
                    let [ax, ay, az] = &flows.asked;
                    let x = place[0] - Lanes::load(cpu, ax, from);
                    let y = place[1] - Lanes::load(cpu, ay, from);
                    let z = place[2] - Lanes::load(cpu, az, from);
                    moved = (x.max(-x).max(y.max(-y)).max(z.max(-z)) + -reach).positive();
                    if !moved.any_positive() {
                        continue;
                    }
                }
                let wanted = moved * wet * (place[2] + -floor).positive();
                let mut answers = None;
                if let Some(beside) = flows.beside.as_mut().filter(|_| wanted.any_positive()) {
                    let found = beside.motions(cpu, waves, from, &Place { clock: at.clock, at: at_point }, wanted);
                    if !(one - wanted).any_positive() {
                        flows.asked.iter_mut().zip(place).for_each(|(row, place)| place.store(row, from));
                        flows.rows.iter_mut().zip(found).for_each(|(row, answer)| answer.store(row, from));
                        continue;
                    }
                    answers = Some(found.map(Lanes::lanes));
                }
                let (places, moved, wet, wanted) = (place.map(Lanes::lanes), moved.lanes(), wet.lanes(), wanted.lanes());
                for lane in (0..V::F64_LANES.min(flows.elements - e)).filter(|lane| moved[*lane] > 0.0) {
                    let (place, to) = (places.map(|row| row[lane]), from + lane);
                    let asked = if wet[lane] > 0.0 { place } else { [f64::INFINITY; 3] };
                    flows.asked.iter_mut().zip(asked).for_each(|(row, number)| row[to] = number);
                    if wanted[lane] == 0.0 {
                        flows.rows.iter_mut().for_each(|row| row[to] = 0.0);
                    } else if let Some(answers) = &answers {
                        flows.rows.iter_mut().zip(answers).for_each(|(row, answer)| row[to] = answer[lane]);
                    } else {
                        questions.put(place, to);
                        if questions.count == MOST_LANES {
                            questions.answer(flows, waves, at);
                        }
                    }
                }
            }
        }
        questions.answer(flows, waves, at);
    }
}
