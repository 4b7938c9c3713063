//! The ends of an element: one vector and its rate at each, which the shape functions combine.

use crate::algebra::polynomial::Cubic;
use crate::algebra::real::Real;
use crate::algebra::triple::Triple;
use crate::rod::state::{COMPONENTS, Field};
use nalgebra::Vector3;

/// One vector at each end of an element and its rate by x = s/L: values a, b and slopes times length.
#[derive(Debug, Clone, Copy)]
pub struct Ends<F: Real> {
    a: Triple<F>,
    da: Triple<F>,
    b: Triple<F>,
    db: Triple<F>,
}

impl Ends<f64> {
    /// Element `e`, of length `length`.
    pub fn gather(field: &Field, e: usize, length: f64) -> Ends<f64> {
        let (at, slope) = (|node| Triple::from(field.position(node)), |node| Triple::from(field.slope(node)) * length);
        Ends { a: at(e), da: slope(e), b: at(e + 1), db: slope(e + 1) }
    }

    /// Component along a vector as a cubic.
    pub fn along(&self, direction: &Vector3<f64>) -> Cubic {
        Cubic(self.control_values(direction))
    }

    /// The same in every lane.
    #[inline(always)]
    pub fn splat<F: Real>(&self, cpu: F::Cpu) -> Ends<F> {
        Ends {
            a: Triple::splat(cpu, &self.a.into()),
            da: Triple::splat(cpu, &self.da.into()),
            b: Triple::splat(cpu, &self.b.into()),
            db: Triple::splat(cpu, &self.db.into()),
        }
    }

    /// Height (third component) as a cubic.
    pub fn height(&self) -> Cubic {
        Cubic::hermite(self.a.z, self.da.z, self.b.z, self.db.z)
    }
}

impl<F: Real> Ends<F> {
    /// Elements from `e` on, of lengths `length`.
    #[inline(always)]
    pub fn load(cpu: F::Cpu, rows: &[&[f64]; COMPONENTS], e: usize, length: F) -> Ends<F> {
        let [x, y, z, px, py, pz] = rows;
        Ends {
            a: Triple::load(cpu, [x, y, z], e),
            da: Triple::load(cpu, [px, py, pz], e) * length,
            b: Triple::load(cpu, [x, y, z], e + 1),
            db: Triple::load(cpu, [px, py, pz], e + 1) * length,
        }
    }

    /// Value where the shape functions are `n` (unit length).
    #[inline(always)]
    pub fn combine(&self, n: &[f64; 4]) -> Triple<F> {
        self.a.scale_add(n[0], self.da.scale_add(n[1], self.b.scale_add(n[2], self.db.scale(n[3]))))
    }

    /// Value where the shape functions are `n` in each lane (unit length).
    #[inline(always)]
    pub fn combine_lanes(&self, n: &[F; 4]) -> Triple<F> {
        self.a.mul_add(n[0], self.da.mul_add(n[1], self.b.mul_add(n[2], self.db * n[3])))
    }

    /// Bézier control values of the component along a vector: the curve lies between the least and the greatest of them.
    #[inline(always)]
    pub fn control_values(&self, direction: &Vector3<f64>) -> [F; 4] {
        let (first, last) = (self.a.along(direction), self.b.along(direction));
        let third = 1.0 / 3.0;
        [first, self.da.along(direction).scale_add(third, first), self.db.along(direction).scale_add(-third, last), last]
    }

    /// 1 where the element is certainly below the waterline, else 0.
    #[inline(always)]
    pub fn wet(&self, waterline: F) -> F {
        let third = 1.0 / 3.0;
        let top = self.a.z.max(self.b.z).max(self.da.z.scale_add(third, self.a.z)).max(self.db.z.scale_add(-third, self.b.z));
        (waterline - top).step()
    }

    /// End values and end slopes times length: r_i, L p_i, r_j, L p_j.
    #[inline(always)]
    pub fn parts(&self) -> [Triple<F>; 4] {
        [self.a, self.da, self.b, self.db]
    }
}
