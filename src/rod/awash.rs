//! The water on elements that may not be all wet: force on the wet share, integrated over the parts below the surface.
//!
//! The fast loop leaves the water out on such elements. Their quadrature points are few and unlike those of the loop, but all of one
//! element: they are looked at side by side, as the loop does with elements.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::lanes::Lanes;
use crate::algebra::polynomial::{Cubic, Interval};
use crate::algebra::real::{MOST_LANES, Real};
use crate::algebra::shape::{self, GAUSS3, GAUSS4, GaussPoint, Shape};
use crate::algebra::tensor::Tensor;
use crate::algebra::triple::Triple;
use crate::rod::element::Table;
use crate::rod::element_tangent::ElementTangent;
use crate::rod::ends::Ends;
use crate::rod::mesh::Mesh;
use crate::rod::morison::{self, Coefficients, Past, PointMotion, Water};
use crate::rod::motion::{Motion, Weights};
use crate::rod::stretch::Direction;
use crate::rod::surface::{self, MOST_PARTS};
use crate::sea::beside::{Beside, Place};
use crate::sea::clock::Clock;
use crate::sea::waves::{Flow, Waves};
use pulp::{Simd, WithSimd};

/// What leaves a line when it leaves the water: buoyancy, drag and added mass.
#[derive(Debug, Clone)]
pub struct Surface {
    diameter: Vec<f64>,
    buoyancy: Vec<f64>,
}

impl Surface {
    /// The surface for a mesh.
    pub fn new(mesh: &Mesh) -> Surface {
        let of = |f: &dyn Fn(usize) -> f64| (0..mesh.elements.len()).map(f).collect();
        Surface {
            diameter: of(&|e| mesh.properties_of(e).diameter),
            buoyancy: of(&|e| mesh.properties_of(e).weight_in_air - mesh.properties_of(e).weight),
        }
    }

    /// Room for what the points of such elements keep of a sea; none where they had better ask for themselves.
    pub fn beside(waves: &Waves) -> Option<Beside> {
        Beside::new(waves, KEPT * MOST_LANES, KEPT * MOST_LANES)
    }

    /// The element and its wet parts, unless it is certainly all wet.
    fn lifted<'a, W: Water>(
        &'a self,
        table: &Table,
        water: &'a W,
        kept: Option<&mut Beside>,
        at: &Motion,
        e: usize,
    ) -> Option<WetShare<'a, W>> {
        let length = table.length_of(e);
        let u = Ends::gather(at.u, e, length);
        let height = u.height();
        if height.below(water.lowest_surface() - 0.5 * self.diameter[e]) || table.is_joint(e) {
            return None;
        }
        let height = match (water.waves(), kept) {
            (Some(waves), Some(kept)) => {
                let elevations = Elevations { waves, kept, u: &u, clock: at.clock, at: KEPT * MOST_LANES + first_of(e) };
                surface::above(&u, table.processor.dispatch(elevations))
            }
            (Some(_), None) => surface::above_waves(&u, water, &at.clock),
            (None, _) => height,
        };
        Some(WetShare {
            water,
            clock: at.clock,
            ends: [u, Ends::gather(at.v, e, length), Ends::gather(at.a, e, length)],
            per_length: 1.0 / length,
            per_diameter: 1.0 / self.diameter[e],
            buoyancy: self.buoyancy[e],
            coefficients: table.coefficients(e),
            first: first_of(e),
            points: self.points(&height, e, length),
            height,
        })
    }

    /// What the force of the water on the wet share of element `e` adds to the forces on its ends, if the element is lifted.
    pub fn forces<W: Water>(
        &self,
        table: &Table,
        water: &W,
        mut kept: Option<&mut Beside>,
        at: &Motion,
        e: usize,
    ) -> Option<[Triple<f64>; 4]> {
        let share = &self.lifted(table, water, kept.as_deref_mut(), at, e)?;
        Some(table.processor.dispatch(Forces { share, kept }))
    }

    /// Quadrature points of the wet parts of an element, given its height above the water and its length.
    fn points(&self, height: &Cubic, e: usize, length: f64) -> Points {
        let mut points = Points::default();
        for &part in surface::wet_parts(height, self.diameter[e]).as_slice() {
            for point in self.rule(height, part, e) {
                let span = part.to - part.from;
                points.push(part.from + span * point.x, span * point.weight * length);
            }
        }
        points
    }

    /// Three points under water, as in the fast loop; four where the line is awash, which are exact for its buoyancy.
    fn rule(&self, height: &Cubic, part: Interval, e: usize) -> &'static [GaussPoint] {
        if height.at(0.5 * (part.from + part.to)) < -0.5 * self.diameter[e] { &GAUSS3 } else { &GAUSS4 }
    }

    /// Adds the tangent of the force of the water on the wet share of a lifted element to the matrix.
    #[allow(clippy::too_many_arguments)]
    pub fn tangent<W: Water>(
        &self,
        table: &Table,
        water: &W,
        mut kept: Option<&mut Beside>,
        at: &Motion,
        e: usize,
        weights: &Weights,
        matrix: &mut BlockTridiagonal<6>,
    ) {
        let Some(share) = self.lifted(table, water, kept.as_deref_mut(), at, e) else { return };
        let sum = table.processor.dispatch(Changes { share: &share, kept, weights });
        sum.add_to(matrix, e, table.length_of(e), e + 1);
    }
}

/// So many elements in a row have room for what their first points know of a sea.
const KEPT: usize = 16;

/// The number of the first point of element `e` among those that keep.
fn first_of(e: usize) -> usize {
    (e % KEPT) * MOST_LANES
}

/// Room for the quadrature points of an element, and for zeros behind them.
const ROOM: usize = MOST_PARTS * GAUSS4.len() + MOST_LANES;

/// Quadrature points on [0, 1] and their weights [m]; of weight zero beyond the last.
struct Points {
    x: [f64; ROOM],
    weight: [f64; ROOM],
    count: usize,
}

impl Default for Points {
    fn default() -> Self {
        Points { x: [0.0; ROOM], weight: [0.0; ROOM], count: 0 }
    }
}

impl Points {
    fn push(&mut self, x: f64, weight: f64) {
        (self.x[self.count], self.weight[self.count]) = (x, weight);
        self.count += 1;
    }
}

/// The wet share of one element.
struct WetShare<'a, W> {
    water: &'a W,
    clock: Clock,
    /// Of u, v and a.
    ends: [Ends<f64>; 3],
    per_length: f64,
    height: Cubic,
    per_diameter: f64,
    buoyancy: f64,
    coefficients: Coefficients<f64>,
    /// Number of the first point among those that keep what they know of a sea.
    first: usize,
    points: Points,
}

/// A wet share in every lane.
struct InLanes<'a, F: Real, W> {
    share: &'a WetShare<'a, W>,
    cpu: F::Cpu,
    ends: [Ends<F>; 3],
    coefficients: Coefficients<F>,
}

/// Quadrature points side by side.
struct WetPoints<F: Real> {
    /// Shape functions there, of unit length.
    value: [F; 4],
    slope: [F; 4],
    weight: F,
    motion: PointMotion<F>,
    /// ½ - z/d, of which the wet fraction is the part between 0 and 1.
    draught: F,
}

impl<F: Real> WetPoints<F> {
    /// φ.
    #[inline(always)]
    fn wet(&self, cpu: F::Cpu) -> F {
        self.draught.max(F::splat(cpu, 0.0)).min(F::splat(cpu, 1.0))
    }
}

impl<'a, F: Real, W: Water> InLanes<'a, F, W> {
    #[inline(always)]
    fn new(cpu: F::Cpu, share: &'a WetShare<'a, W>) -> Self {
        let [u, v, a] = &share.ends;
        InLanes { share, cpu, ends: [u.splat(cpu), v.splat(cpu), a.splat(cpu)], coefficients: share.coefficients.splat(cpu) }
    }

    /// The points from `first` on.
    #[inline(always)]
    fn points(&self, first: usize) -> WetPoints<F> {
        let (share, cpu, [u, v, a]) = (self.share, self.cpu, &self.ends);
        let (x, weight) = (F::load(cpu, &share.points.x, first), F::load(cpu, &share.points.weight, first));
        let (value, slope) = shape::in_lanes(x);
        let place = u.combine_lanes(&value);
        let height = if W::WAVES { share.height.in_lanes(x) } else { place.z };
        let motion = PointMotion {
            clock: share.clock,
            direction: Direction::of(u.combine_lanes(&slope) * F::splat(cpu, share.per_length)),
            place,
            velocity: v.combine_lanes(&value),
            acceleration: a.combine_lanes(&value),
        };
        WetPoints { value, slope, weight, motion, draught: height * -share.per_diameter + 0.5 }
    }

    /// Force of the water that moves past the line under water [N/m].
    #[inline(always)]
    fn force(&self, points: &WetPoints<F>, past: Past<F>) -> Triple<F> {
        let mut force = Triple::zero(self.cpu);
        if W::PRESENT {
            force = morison::force_past(self.share.water, &self.coefficients, &points.motion, past);
        }
        force.z = force.z + self.share.buoyancy;
        force
    }
}

impl<V: Simd, W: Water> InLanes<'_, Lanes<V>, W> {
    /// The motion of the water past the points from `first` on.
    #[inline(always)]
    fn past(&self, points: &WetPoints<Lanes<V>>, first: usize, kept: &mut Option<&mut Beside>) -> Past<Lanes<V>> {
        let (cpu, share) = (self.cpu, self.share);
        match (share.water.waves(), kept) {
            (Some(waves), Some(kept)) if first < MOST_LANES => {
                let place = Place { clock: share.clock, at: points.motion.place };
                let [vx, vy, vz, ax, ay, az] = kept.motions(cpu, waves, share.first + first, &place, points.weight.positive());
                let (velocity, acceleration) = (Triple { x: vx, y: vy, z: vz }, Triple { x: ax, y: ay, z: az });
                share.water.past_with(cpu, &points.motion, &Flow { velocity, acceleration })
            }
            _ => share.water.past(cpu, &points.motion),
        }
    }
}

/// The elevation of a sea at the places where an element's height above it is taken.
struct Elevations<'a> {
    waves: &'a Waves,
    kept: &'a mut Beside,
    u: &'a Ends<f64>,
    clock: Clock,
    at: usize,
}

impl WithSimd for Elevations<'_> {
    type Output = [f64; 4];

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> [f64; 4] {
        let Elevations { waves, kept, u, clock, at } = self;
        let [mut x, mut y] = [[0.0; MOST_LANES]; 2];
        for (lane, (x, y)) in x.iter_mut().zip(&mut y).enumerate() {
            let place = u.combine(&Shape::at(surface::TAKEN_AT[lane.min(3)]).value);
            (*x, *y) = (place.x, place.y);
        }
        let wanted = [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0];
        let mut found = [0.0; MOST_LANES];
        for lane in (0..4).step_by(V::F64_LANES) {
            let place = Place { clock, at: Triple::load(cpu, [&x, &y, &[0.0; MOST_LANES]], lane) };
            kept.elevation(cpu, waves, at + lane, &place, Lanes::load(cpu, &wanted, lane)).store(&mut found, lane);
        }
        [found[0], found[1], found[2], found[3]]
    }
}

/// Minus the force of the water on the wet share of one element, on its ends: the points of its quadrature side by side.
struct Forces<'a, W> {
    share: &'a WetShare<'a, W>,
    kept: Option<&'a mut Beside>,
}

impl<W: Water> WithSimd for Forces<'_, W> {
    type Output = [Triple<f64>; 4];

    #[inline(always)]
    fn with_simd<V: Simd>(mut self, cpu: V) -> [Triple<f64>; 4] {
        let lanes = InLanes::<Lanes<V>, W>::new(cpu, self.share);
        let mut sum = [Triple::<Lanes<V>>::zero(cpu); 4];
        let mut first = 0;
        while first < self.share.points.count {
            let points = lanes.points(first);
            let past = lanes.past(&points, first, &mut self.kept);
            let force = lanes.force(&points, past) * (-points.wet(cpu) * points.weight);
            let mut k = 0;
            while k < 4 {
                sum[k] = force.mul_add(points.value[k], sum[k]);
                k += 1;
            }
            first += V::F64_LANES;
        }
        [sum[0].total(), sum[1].total(), sum[2].total(), sum[3].total()]
    }
}

/// The tangent of `Forces`.
struct Changes<'a, W> {
    share: &'a WetShare<'a, W>,
    kept: Option<&'a mut Beside>,
    weights: &'a Weights,
}

impl<W: Water> WithSimd for Changes<'_, W> {
    type Output = ElementTangent<f64>;

    #[inline(always)]
    fn with_simd<V: Simd>(mut self, cpu: V) -> ElementTangent<f64> {
        let lanes = InLanes::<Lanes<V>, W>::new(cpu, self.share);
        let (zero, one) = (Lanes::<V>::splat(cpu, 0.0), Lanes::<V>::splat(cpu, 1.0));
        let mut sum = ElementTangent::<Lanes<V>>::zero(cpu);
        let mut first = 0;
        while first < self.share.points.count {
            let points = lanes.points(first);
            let wet = points.wet(cpu);
            let past = lanes.past(&points, first, &mut self.kept);
            // Where the line is awash, φ falls with height.
            let awash =
                points.draught.positive() * (one - points.draught).positive() * (self.share.per_diameter * self.weights.u);
            let mut load = Tensor::isotropic(cpu, zero);
            load.0[2] = lanes.force(&points, past) * awash;
            let mut turning = Tensor::isotropic(cpu, zero);
            if W::PRESENT {
                let water = morison::tangent_past(cpu, self.share.water, &lanes.coefficients, &points.motion, past, self.weights);
                load = water.by_motion.mul_add(-wet, load);
                turning = water.by_slope.times(-wet);
            }
            let per_length = Lanes::<V>::splat(cpu, self.share.per_length);
            sum.add_points([&points.value, &points.slope], points.weight, per_length, load, turning);
            first += V::F64_LANES;
        }
        sum.total()
    }
}
