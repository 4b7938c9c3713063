//! A bed with dampers or friction under elements that lie on it all along, several side by side.
//!
//! The same forces as `touching` finds one by one; elements that touch in part are left to it.

use crate::algebra::dimension::Spatial;
use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real};
use crate::algebra::shape::{GAUSS3, GAUSS4, SHAPES3, SHAPES4};
use crate::algebra::triple::Triple;
use crate::rod::element::{self, Batch, Property, Table};
use crate::rod::ends::Ends;
use crate::rod::motion::Motion;
use crate::rod::parts::{PART_MEANS, PART_POINTS};
use crate::rod::seabed::{self, Depth, PRODUCTS, Plane, combined};
use crate::rod::state::{COMPONENTS, Field};
use crate::rod::touching::Ground;
use nalgebra::Vector3;
use pulp::{Simd, WithSimd};

/// The bed: rows with one number per element.
#[derive(Debug, Clone)]
pub struct Lying {
    plane: Plane,
    onset: Vec<f64>,
    stiffness: Vec<f64>,
    dampers: Option<Dampers>,
    rough: Option<Rough>,
}

/// c and 1/δ.
#[derive(Debug, Clone)]
struct Dampers {
    damping: Vec<f64>,
    per_easing: Vec<f64>,
}

/// Bound over push, axes along the bed, k_t, and what it is kept by.
#[derive(Debug, Clone)]
struct Rough {
    coefficient: f64,
    axes: [Vector3<f64>; 2],
    stiffness: Vec<f64>,
    per_kept: Vec<f64>,
}

impl Lying {
    /// The bed under a line, where it dissipates.
    pub fn new(ground: &Ground) -> Option<Lying> {
        let resistance = &ground.resistance;
        let damped = resistance.iter().any(|resistance| resistance.damping != 0.0);
        if !damped && ground.friction.is_none() {
            return None;
        }
        let row = |of: &dyn Fn(usize) -> f64| seabed::row(resistance.len(), of);
        let dampers = damped
            .then(|| Dampers { damping: row(&|e| resistance[e].damping), per_easing: row(&|e| resistance[e].easing.recip()) });
        let rough = ground.friction.as_ref().map(|friction| Rough {
            coefficient: friction.coefficient(),
            axes: friction.axes(),
            stiffness: row(&|e| friction.stiffness(e)),
            per_kept: row(&|e| friction.kept(e).recip()),
        });
        Some(Lying {
            plane: ground.plane,
            onset: row(&|e| resistance[e].onset),
            stiffness: row(&|e| resistance[e].stiffness),
            dampers,
            rough,
        })
    }

    /// Adds what the bed does to every element to the residual.
    pub fn add_to(&self, ground: &Ground, table: &Table, at: &Motion, out: &mut Field) {
        table.processor.dispatch(Forces { lying: self, ground, table, at, sink: Nodes { table, out } });
    }

    /// Adds what the bed does to the forces on the last end of every element [N], and on the first end of the first, as `element::end_forces`.
    pub fn add_to_ends(&self, ground: &Ground, table: &Table, at: &Motion, out: &mut [Vector3<f64>]) {
        table.processor.dispatch(Forces { lying: self, ground, table, at, sink: LastEnds { out } });
    }

    /// Moves the places of the bed to which the line holds on after a step to these positions and velocities.
    pub fn hold(&self, ground: &Ground, table: &Table, u: &Field, v: &Field, holds: &mut Field) {
        if let Some(rough) = &self.rough {
            table.processor.dispatch(Holds { lying: self, rough, ground, table, u, v, holds });
        }
    }

    /// What resists the penetration of elements from `e` on.
    #[inline(always)]
    fn pushed<F: Real>(&self, cpu: F::Cpu, v: &[&[f64]; COMPONENTS], length: F, p: [F; 4], e: usize) -> Pushed<F> {
        let zero = F::splat(cpu, 0.0);
        let mut pushed = Pushed {
            stiffness: F::load(cpu, &self.stiffness, e),
            p,
            damped: false,
            rates: [zero; 4],
            damping: zero,
            per_easing: zero,
        };
        if let Some(dampers) = &self.dampers {
            let [a, da, b, db] = Ends::load(cpu, v, e, length).parts();
            let normal = &self.plane.normal;
            pushed.rates = [a.along(normal), da.along(normal), b.along(normal), db.along(normal)];
            pushed.damping = F::load(cpu, &dampers.damping, e);
            pushed.per_easing = F::load(cpu, &dampers.per_easing, e);
            pushed.damped = true;
        }
        pushed
    }
}

/// What resists a penetration.
struct Pushed<F> {
    stiffness: F,
    p: [F; 4],
    damped: bool,
    /// End values and slopes of the normal velocity.
    rates: [F; 4],
    damping: F,
    per_easing: F,
}

impl<F: Real> Pushed<F> {
    /// Push where the shape functions are `n` [N/m], as `Resistance::push`.
    #[inline(always)]
    fn at(&self, cpu: F::Cpu, n: &[f64; 4]) -> F {
        let penetration = combined(n, &self.p);
        let eased = (penetration * self.per_easing).min(F::splat(cpu, 1.0));
        (self.stiffness * penetration - combined(n, &self.rates) * eased * self.damping).max(F::splat(cpu, 0.0))
    }

    /// Push on the ends of an element of unit length.
    #[inline(always)]
    fn on_ends(&self, cpu: F::Cpu) -> [F; 4] {
        let mut pushes = [F::splat(cpu, 0.0); 4];
        if self.damped {
            for (point, shape) in GAUSS4.iter().zip(&SHAPES4) {
                let push = self.at(cpu, &shape.value) * point.weight;
                for k in 0..4 {
                    pushes[k] = push.scale_add(shape.value[k], pushes[k]);
                }
            }
        } else {
            for k in 0..4 {
                pushes[k] = combined(&PRODUCTS[k], &self.p) * self.stiffness * (1.0 / 420.0);
            }
        }
        pushes
    }

    /// Mean push on part `g` [N/m].
    #[inline(always)]
    fn on_part(&self, cpu: F::Cpu, g: usize) -> F {
        if !self.damped {
            return combined(&PART_MEANS[g], &self.p) * self.stiffness;
        }
        let mut sum = F::splat(cpu, 0.0);
        for (value, weight) in &PART_POINTS[g] {
            sum = self.at(cpu, value).scale_add(*weight, sum);
        }
        sum
    }
}

impl Rough {
    /// Place and friction at part `g`, along the axes of the bed, under a push [m, N/m].
    #[inline(always)]
    fn grip<F: Real>(&self, cpu: F::Cpu, u: &Ends<F>, holds: &[&[f64]; COMPONENTS], push: F, g: usize, e: usize) -> [[F; 2]; 2] {
        let place = u.combine(&SHAPES3[g].value);
        let place = [place.along(&self.axes[0]), place.along(&self.axes[1])];
        let stiffness = F::load(cpu, &self.stiffness, e);
        let pull =
            [(F::load(cpu, holds[2 * g], e) - place[0]) * stiffness, (F::load(cpu, holds[2 * g + 1], e) - place[1]) * stiffness];
        let size = (pull[0] * pull[0] + pull[1] * pull[1]).sqrt().max(F::splat(cpu, f64::MIN_POSITIVE));
        let bound = push.max(F::splat(cpu, 0.0)) * self.coefficient;
        // All of the pull, or as much as the push allows.
        let share = (bound * size.reciprocal()).min(F::splat(cpu, 1.0));
        [place, [pull[0] * share, pull[1] * share]]
    }
}

/// Where forces go.
trait Sink {
    /// Those on the ends of `count` elements from `e` on, of these lengths (forces, and moments for slopes times length).
    fn take<F: Real>(&mut self, cpu: F::Cpu, e: usize, count: usize, length: F, ends: &[Triple<F>; 4]);
    /// Those on the ends of one element.
    fn take_one(&mut self, e: usize, ends: &[Triple<f64>; 4]);
}

/// To the nodes.
struct Nodes<'a> {
    table: &'a Table,
    out: &'a mut Field,
}

impl Sink for Nodes<'_> {
    #[inline(always)]
    fn take<F: Real>(&mut self, cpu: F::Cpu, e: usize, _: usize, length: F, ends: &[Triple<F>; 4]) {
        element::add_to_nodes(cpu, self.out, e, length, ends);
    }

    fn take_one(&mut self, e: usize, ends: &[Triple<f64>; 4]) {
        element::scatter_to_nodes(self.out, e, self.table.length_of(e), ends);
    }
}

/// To the forces on last ends.
struct LastEnds<'a> {
    out: &'a mut [Vector3<f64>],
}

impl Sink for LastEnds<'_> {
    #[inline(always)]
    fn take<F: Real>(&mut self, cpu: F::Cpu, e: usize, count: usize, _: F, ends: &[Triple<F>; 4]) {
        let ([x, y, z], mut row) = (ends[2].components(cpu), [0.0; MOST_LANES]);
        for (c, of) in [x, y, z].into_iter().enumerate() {
            of.store(&mut row, 0);
            for lane in 0..count {
                self.out[e + lane + 1][c] += row[lane];
            }
        }
        if e == 0 {
            let [x, y, z] = ends[0].components(cpu);
            self.out[0] += Vector3::new(x.first(), y.first(), z.first());
        }
    }

    fn take_one(&mut self, e: usize, ends: &[Triple<f64>; 4]) {
        self.out[e + 1] += Vector3::from(ends[2]);
        if e == 0 {
            self.out[0] += Vector3::from(ends[0]);
        }
    }
}

/// `Lying::add_to` in the instructions of the processor.
struct Forces<'a, K> {
    lying: &'a Lying,
    ground: &'a Ground,
    table: &'a Table,
    at: &'a Motion<'a>,
    sink: K,
}

impl<K: Sink> WithSimd for Forces<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        let Forces { lying, ground, table, at, mut sink } = self;
        let (positions, velocities, holds) = (at.u.rows(), at.v.rows(), at.holds.rows());
        let (normal, rows) = (&lying.plane.normal, table.rows());
        for e in (0..table.len()).step_by(V::F64_LANES) {
            let batch = Batch::<Lanes<V, Spatial>> { cpu, rows, e };
            let (length, measure) = (batch.get(Property::Length), batch.get(Property::Measure));
            let u = Ends::load(cpu, &positions, e, length);
            let depth = Depth::of(cpu, &lying.plane, &lying.onset, &u, e);
            let (most, least) = (depth.most * measure, depth.least * measure);
            if !most.any_positive() {
                continue;
            }
            let count = V::F64_LANES.min(table.len() - e);
            if least.any_positive() {
                let grounded = measure * least.positive();
                let pushed = lying.pushed(cpu, &velocities, length, depth.ends(), e);
                let pushes = pushed.on_ends(cpu);
                let mut sum = [Triple::zero(cpu); 4];
                for k in 0..4 {
                    sum[k] = Triple::splat(cpu, normal) * (pushes[k] * grounded * -1.0);
                }
                if let Some(rough) = &lying.rough {
                    for g in 0..3 {
                        let [_, friction] = rough.grip(cpu, &u, &holds, pushed.on_part(cpu, g), g, e);
                        for (axis, friction) in rough.axes.iter().zip(friction) {
                            let force = Triple::splat(cpu, axis) * (friction * grounded * -GAUSS3[g].weight);
                            for k in 0..4 {
                                sum[k] = force.scale_add(SHAPES3[g].value[k], sum[k]);
                            }
                        }
                    }
                }
                sink.take(cpu, e, count, length, &sum);
            }
            let part = in_part(most, least);
            if part.any_positive() {
                let lanes = part.lanes();
                for lane in (0..count).filter(|lane| lanes[*lane] > 0.0) {
                    if let Some(forces) = ground.forces(table, at, e + lane) {
                        sink.take_one(e + lane, &forces);
                    }
                }
            }
        }
    }
}

/// `Lying::hold` in the instructions of the processor.
struct Holds<'a> {
    lying: &'a Lying,
    rough: &'a Rough,
    ground: &'a Ground,
    table: &'a Table,
    u: &'a Field,
    v: &'a Field,
    holds: &'a mut Field,
}

impl WithSimd for Holds<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        let Holds { lying, rough, ground, table, u, v, holds } = self;
        let (positions, velocities, rows) = (u.rows(), v.rows(), table.rows());
        let stride = holds.stride();
        for e in (0..table.len()).step_by(V::F64_LANES) {
            let batch = Batch::<Lanes<V, Spatial>> { cpu, rows, e };
            let (length, measure) = (batch.get(Property::Length), batch.get(Property::Measure));
            let ends = Ends::load(cpu, &positions, e, length);
            let depth = Depth::of(cpu, &lying.plane, &lying.onset, &ends, e);
            let (most, least) = (depth.most * measure, depth.least * measure);
            let (per_kept, grounded) = (Lanes::<V, Spatial>::load(cpu, &rough.per_kept, e), least.positive());
            let part = in_part(most, least);
            // What touches in part stays as it is for now; what is no element holds on to nothing.
            let (stays, moves) = (part.positive(), (-part.positive() + 1.0) * measure.positive());
            if !most.any_positive() {
                // What is clear of the bed holds on to where it is.
                for (g, shape) in SHAPES3.iter().enumerate() {
                    let place = ends.combine(&shape.value);
                    for (c, axis) in rough.axes.iter().enumerate() {
                        (place.along(axis) * moves).store(holds.data_mut(), (2 * g + c) * stride + e);
                    }
                }
                continue;
            }
            let pushed = lying.pushed(cpu, &velocities, length, depth.ends(), e);
            for g in 0..3 {
                let push = pushed.on_part(cpu, g) * grounded;
                let [place, friction] = rough.grip(cpu, &ends, &holds.rows(), push, g, e);
                for c in 0..2 {
                    let at = (2 * g + c) * stride + e;
                    let old = Lanes::<V, Spatial>::load(cpu, holds.data(), at);
                    let new = friction[c].mul_add(per_kept, place[c]);
                    new.mul_add(moves, old * stays).store(holds.data_mut(), at);
                }
            }
            if part.any_positive() {
                let lanes = part.lanes();
                for lane in (0..V::F64_LANES.min(table.len() - e)).filter(|lane| lanes[*lane] > 0.0) {
                    ground.hold(table, u, v, e + lane, holds);
                }
            }
        }
    }
}

/// Positive where an element touches, but not all along.
#[inline(always)]
fn in_part<F: Real>(most: F, least: F) -> F {
    most * (-least.positive() + 1.0)
}
