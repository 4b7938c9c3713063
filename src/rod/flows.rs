//! The motion of the water at the Gauss points of a line: asked for at the first iteration of a stage, and again where a point has left its place.
//!
//! A stage begins where the line is expected, so that its iterations move a point by about the error of a step. As long as that is
//! less than `NEAR` of a mean wave's number, the water there is taken to move as it did where it was asked: the error is this share of its velocity
//! at most. Whatever was kept before the first iteration does not matter, so that the bits of a stage depend on the stage alone.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::algebra::shape::SHAPES3;
use crate::algebra::triple::Triple;
use crate::rod::ends::Ends;
use crate::rod::motion::{Asking, Motion};
use crate::sea::waves::{Flow, Waves};
use pulp::{Arch, Simd, WithSimd};

/// Distance times wave number within which the water is not asked again [-].
const NEAR: f64 = 1.0e-3;

/// Motions of the water at three points of every element, and where they were asked for.
#[derive(Debug, Clone)]
pub struct Flows {
    elements: usize,
    /// Lengths of elements [m], and heights below which they are certainly wet [m].
    lengths: Vec<f64>,
    waterlines: Vec<f64>,
    /// Numbers between the first points of all elements and the second.
    stride: usize,
    /// Places [m]; infinite where nothing was asked.
    asked: [Vec<f64>; 3],
    /// Velocities [m/s], then accelerations [m/s²].
    rows: [Vec<f64>; 6],
    processor: Arch,
}

impl Flows {
    /// Room for elements of lengths [m] and heights below which each is certainly wet [m].
    pub fn new(mut lengths: Vec<f64>, mut waterlines: Vec<f64>) -> Flows {
        let elements = lengths.len();
        let stride = padded(elements);
        lengths.resize(stride, 0.0);
        waterlines.resize(stride, 0.0);
        let row = |_| vec![0.0; SHAPES3.len() * stride];
        let (asked, rows) = (std::array::from_fn(row), std::array::from_fn(row));
        Flows { elements, lengths, waterlines, stride, asked, rows, processor: Arch::new() }
    }

    /// Asks for what is not known yet in the stage of a motion.
    pub fn update(&mut self, waves: &Waves, at: &Motion) {
        self.processor.dispatch(Update { flows: self, waves, at });
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

/// `Flows::update` in the instructions of the processor.
struct Update<'a> {
    flows: &'a mut Flows,
    waves: &'a Waves,
    at: &'a Motion<'a>,
}

impl WithSimd for Update<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        let Update { flows, waves, at } = self;
        let (rows, first) = (at.u.rows(), at.asking != Asking::Again);
        let (reach, floor) = (NEAR / waves.mean().1, waves.lowest_motion());
        let mut questions = Questions { count: 0, places: [[0.0; MOST_LANES]; 3], to: [0; MOST_LANES] };
        for e in (0..flows.elements).step_by(V::F64_LANES) {
            let u = Ends::load(cpu, &rows, e, Lanes::<V>::load(cpu, &flows.lengths, e));
            let wet = u.wet(Lanes::load(cpu, &flows.waterlines, e)).lanes();
            for (g, shape) in SHAPES3.iter().enumerate() {
                let [x, y, z] = u.combine(&shape.value).components(cpu);
                let from = g * flows.stride + e;
                let far = |now: Lanes<V>, row: &[f64]| {
                    let off = now - Lanes::load(cpu, row, from);
                    off.max(-off) + -reach
                };
                let [ax, ay, az] = &flows.asked;
                if !first && !far(x, ax).max(far(y, ay)).max(far(z, az)).any_positive() {
                    continue;
                }
                let places = [x.lanes(), y.lanes(), z.lanes()];
                for lane in 0..V::F64_LANES.min(flows.elements - e) {
                    let (place, to) = (places.map(|row| row[lane]), from + lane);
                    let near = |(now, row): (&f64, &Vec<f64>)| (now - row[to]).abs() <= reach;
                    if !first && place.iter().zip(&flows.asked).all(near) {
                        continue;
                    }
                    // Elements that may not be all wet have points of their own.
                    let wanted = wet[lane] > 0.0;
                    let place = if wanted { place } else { [f64::INFINITY; 3] };
                    flows.asked.iter_mut().zip(place).for_each(|(row, number)| row[to] = number);
                    if wanted && place[2] > floor {
                        questions.put(place, to);
                        if questions.count == MOST_LANES {
                            questions.answer(flows, waves, at);
                        }
                    } else {
                        flows.rows.iter_mut().for_each(|row| row[to] = 0.0);
                    }
                }
            }
        }
        questions.answer(flows, waves, at);
    }
}
