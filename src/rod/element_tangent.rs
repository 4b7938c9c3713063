//! The tangent of the loads on the elements, and where it goes in the matrix of the line.
//!
//! ```text
//! K_kl = Σ_g w_g L [ N_k N_l X_r + N_k N′_l X_r′ + N′_k N′_l n_r′ + N″_k N″_l EI c_u ]
//! ```
//!
//! X_r, X_r′ weighted changes of the load with the motion of a point and with its slope, n_r′ of the axial force with slope and rate.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::dimension::Dimension;
use crate::algebra::lanes::Lanes;
use crate::algebra::real::Across;
use crate::algebra::real::{MOST_LANES, Real};
use crate::algebra::shape::{GAUSS3, SHAPES3, Shape};
use crate::algebra::tensor::Tensor;
use crate::rod::bending::Bending;
use crate::rod::element::{Batch, Property, Source, Table, with_curve};
use crate::rod::ends::Ends;
use crate::rod::flows::Flows;
use crate::rod::morison::{self, PointMotion, Water};
use crate::rod::motion::{Motion, Weights};
use crate::rod::stretch::{By, Direction, Stretch};
use pulp::{NullaryFnOnce, Simd, WithSimd};
use std::marker::PhantomData;

/// Tangent of the loads at one point, already weighted: δX = load·δr + turning·δr′, δn = axial·δr′, δ(EI r″) = bending·δr″.
#[derive(Debug, Clone, Copy)]
pub struct PointTangent<F: Real> {
    /// Change of X with position, velocity and acceleration.
    pub load: Tensor<F>,
    /// Change of X with the slope.
    pub turning: Tensor<F>,
    /// Change of n with the slope and its rate.
    pub axial: Tensor<F>,
    /// EI c_u.
    pub bending: Option<F>,
}

impl PointTangent<f64> {
    /// A load that changes with the motion alone.
    pub fn of_load(load: Tensor<f64>) -> Self {
        let zero = Tensor::isotropic((), 0.0);
        PointTangent { load, turning: zero, axial: zero, bending: None }
    }
}

/// Tangent of elements, by the end values r_i, L p_i, r_j, L p_j: [l][k] couples end value k with end value l.
#[derive(Debug, Clone, Copy)]
pub struct ElementTangent<F: Real>([[Tensor<F>; 4]; 4]);

impl<F: Real> ElementTangent<F> {
    /// Zero.
    #[inline(always)]
    pub fn zero(cpu: F::Cpu) -> Self {
        ElementTangent([[Tensor::isotropic(cpu, F::splat(cpu, 0.0)); 4]; 4])
    }

    /// Adds `measure` times the tangent at a point of elements of length 1/`per_length`.
    #[inline(always)]
    pub fn add(&mut self, shape: &Shape, measure: F, per_length: F, point: &PointTangent<F>) {
        let turning = point.turning.times(measure * per_length);
        let load = point.load.times(measure);
        let axial = point.axial.times(measure * per_length * per_length);
        let bending = point.bending.map(|stiffness| stiffness * measure * per_length * per_length * per_length * per_length);
        for l in 0..4 {
            let loads = load.scale_add(shape.value[l], turning.scale(shape.slope[l]));
            let axials = axial.scale(shape.slope[l]);
            for k in 0..4 {
                let block = &mut self.0[l][k];
                *block = loads.scale_add(shape.value[k], axials.scale_add(shape.slope[k], *block));
                if let Some(bending) = bending {
                    let bending = bending * (shape.curvature[k] * shape.curvature[l]);
                    block.0[0].x = block.0[0].x + bending;
                    block.0[1].y = block.0[1].y.plus(F::Across::of(bending));
                    block.0[2].z = block.0[2].z + bending;
                }
            }
        }
    }

    /// Adds `measure` times the change of the load at a point of its own in every lane, all of one element of length 1/`per_length`, where the
    /// shape functions are `value` and `slope` (unit length).
    #[inline(always)]
    pub fn add_points(&mut self, [value, slope]: [&[F; 4]; 2], measure: F, per_length: F, load: Tensor<F>, turning: Tensor<F>) {
        let (load, turning) = (load.times(measure), turning.times(measure * per_length));
        let mut l = 0;
        while l < 4 {
            let loads = load.mul_add(value[l], turning.times(slope[l]));
            let mut k = 0;
            while k < 4 {
                self.0[l][k] = loads.mul_add(value[k], self.0[l][k]);
                k += 1;
            }
            l += 1;
        }
    }

    /// The sum of all lanes.
    #[inline(always)]
    pub fn total(&self) -> ElementTangent<f64> {
        let mut sum = ElementTangent::zero(());
        let mut at = 0;
        while at < 16 {
            let (l, k) = (at / 4, at % 4);
            let [x, y, z] = self.0[l][k].0;
            sum.0[l][k] = Tensor([x.total(), y.total(), z.total()]);
            at += 1;
        }
        sum
    }

    /// Adds products[k][l] times one matrix to block (k, l).
    pub fn add_products(&mut self, products: &[[f64; 4]; 4], matrix: &Tensor<F>) {
        for l in 0..4 {
            for k in 0..4 {
                self.0[l][k] = matrix.scale_add(products[k][l], self.0[l][k]);
            }
        }
    }

    /// Adds the tangent of the elements from `first` on, of lengths `length`, to the matrix of a line of `count` elements.
    #[inline(always)]
    pub fn add_to(&self, matrix: &mut BlockTridiagonal<6>, first: usize, length: F, count: usize) {
        let square = length * length;
        let mut entries = [[0.0; MOST_LANES]; 9];
        for l in 0..4 {
            for k in 0..4 {
                let scaled = match k % 2 + l % 2 {
                    0 => self.0[l][k],
                    1 => self.0[l][k].times(length),
                    _ => self.0[l][k].times(square),
                };
                for (c, column) in scaled.0.into_iter().enumerate() {
                    column.x.store(&mut entries[3 * c], 0);
                    column.y.write(&mut entries[3 * c + 1], 0);
                    column.z.store(&mut entries[3 * c + 2], 0);
                }
                for lane in 0..F::LANES.min(count - first) {
                    let e = first + lane;
                    let target = match (k / 2, l / 2) {
                        (0, 0) => &mut matrix.diagonal[e],
                        (1, 1) => &mut matrix.diagonal[e + 1],
                        (0, _) => &mut matrix.upper[e],
                        _ => &mut matrix.lower[e],
                    };
                    for c in 0..3 {
                        for r in 0..3 {
                            target[(3 * (k % 2) + r, 3 * (l % 2) + c)] += entries[3 * c + r][lane];
                        }
                    }
                }
            }
        }
    }
}

/// Adds the tangent of the elements between the nodes of each of `runs`, from its first to the one before its end, to the matrix.
/// `geometric[3e + g]`, where given, is the tension of the geometric part.
#[allow(clippy::too_many_arguments)]
pub fn tangent<S: Stretch, W: Water, B: Bending, D: Dimension>(
    table: &Table,
    water: &W,
    flows: Option<&Flows>,
    at: &Motion,
    weights: &Weights,
    geometric: Option<&[f64]>,
    runs: &[(usize, usize)],
    matrix: &mut BlockTridiagonal<6>,
) {
    let mut source = Source::new(table, water, None, at);
    source.flows = flows;
    table.processor.dispatch(Assembly::<S, W, B, D> { runs, source, weights, geometric, matrix, laws: PhantomData });
}

struct Assembly<'a, S, W, B, D> {
    runs: &'a [(usize, usize)],
    source: Source<'a, W>,
    weights: &'a Weights,
    geometric: Option<&'a [f64]>,
    matrix: &'a mut BlockTridiagonal<6>,
    laws: PhantomData<(S, B, D)>,
}

impl<S: Stretch, W: Water, B: Bending, D: Dimension> WithSimd for Assembly<'_, S, W, B, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        let Assembly { runs, source, weights, geometric, matrix, .. } = self;
        for (first, count) in runs.iter().map(|(first, end)| (*first, end - 1)) {
            for e in (first..count).step_by(V::F64_LANES) {
                let mut tensions = [[0.0; MOST_LANES]; 3];
                if let Some(geometric) = geometric {
                    for lane in 0..V::F64_LANES.min(count - e) {
                        (0..3).for_each(|g| tensions[g][lane] = geometric[3 * (e + lane) + g]);
                    }
                }
                let geometric = geometric.map(|_| &tensions);
                let sum = batch_tangent::<V, S, W, B, D>(cpu, &source, e, weights, geometric);
                let length = Batch::<Lanes<V, D>> { cpu, rows: source.table, e }.get(Property::Length);
                cpu.vectorize(Scatter { sum: &sum, matrix, first: e, length, count });
            }
        }
    }
}

/// Tangent of the elements from `e` on.
#[inline(always)]
fn batch_tangent<V: Simd, S: Stretch, W: Water, B: Bending, D: Dimension>(
    cpu: V,
    source: &Source<W>,
    e: usize,
    weights: &Weights,
    geometric: Option<&[[f64; MOST_LANES]; 3]>,
) -> ElementTangent<Lanes<V, D>> {
    let table = Batch::<Lanes<V, D>> { cpu, rows: source.table, e };
    let (length, per_length, measure) =
        (table.get(Property::Length), table.get(Property::PerLength), table.get(Property::Measure));
    let (axial, coefficients) = (table.axial(), table.coefficients());
    let mass = table.get(Property::Mass) * weights.a;
    let bending = B::PRESENT.then(|| table.get(Property::Ei) * weights.u);
    let u = Ends::load(cpu, &source.u, e, length);
    let v = Ends::load(cpu, &source.v, e, length);
    let a = Ends::load(cpu, &source.a, e, length);
    let wet = source.wet(cpu, &u, table.get(Property::Waterline), e);
    let by = By { slope: weights.u, rate: weights.v };
    let mut sum = ElementTangent::zero(cpu);
    for (g, (gauss, shape)) in GAUSS3.iter().zip(&SHAPES3).enumerate() {
        let direction = Direction::of(u.combine(&shape.slope) * per_length);
        let rate = v.combine(&shape.slope) * per_length;
        let geometric = geometric.map(|tensions| Lanes::load(cpu, &tensions[g], 0));
        let curved = with_curve::<Lanes<V, D>, S>(axial, cpu, source.curves, e, &direction, u.combine(&shape.value).z);
        let mut point = PointTangent {
            load: Tensor::isotropic(cpu, mass),
            turning: Tensor::isotropic(cpu, Lanes::splat(cpu, 0.0)),
            axial: S::tangent(cpu, &curved, &direction, rate, geometric, by),
            bending,
        };
        if W::PRESENT {
            let motion = PointMotion {
                clock: source.clock,
                direction,
                place: u.combine(&shape.value),
                velocity: v.combine(&shape.value),
                acceleration: a.combine(&shape.value),
            };
            let past = source.past(cpu, &motion, g, e);
            let water = morison::tangent_past(cpu, source.water, &coefficients, &motion, past, weights);
            point.load = water.by_motion.mul_add(-wet, point.load);
            point.turning = water.by_slope.times(-wet);
        }
        cpu.vectorize(Addition { sum: &mut sum, shape, measure: measure * gauss.weight, per_length, point: &point });
    }
    sum
}

/// `ElementTangent::add`, compiled once for a processor and not for every kind of line.
struct Addition<'a, V: Simd, D: Dimension> {
    sum: &'a mut ElementTangent<Lanes<V, D>>,
    shape: &'a Shape,
    measure: Lanes<V, D>,
    per_length: Lanes<V, D>,
    point: &'a PointTangent<Lanes<V, D>>,
}

impl<V: Simd, D: Dimension> NullaryFnOnce for Addition<'_, V, D> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.sum.add(self.shape, self.measure, self.per_length, self.point);
    }
}

/// `ElementTangent::add_to`, likewise.
struct Scatter<'a, V: Simd, D: Dimension> {
    sum: &'a ElementTangent<Lanes<V, D>>,
    matrix: &'a mut BlockTridiagonal<6>,
    first: usize,
    length: Lanes<V, D>,
    count: usize,
}

impl<V: Simd, D: Dimension> NullaryFnOnce for Scatter<'_, V, D> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.sum.add_to(self.matrix, self.first, self.length, self.count);
    }
}
