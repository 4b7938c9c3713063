//! Friction of the seabed: Coulomb's law with a small elastic breakaway, so that a line at rest stays where it is.
//!
//! ```text
//! f = -k_t d,  |f| ≤ μ p,   d = P (r - r_h),   P = I - N Nᵀ,   k_t = μ w / δ,   δ = d/10
//! ```
//!
//! f friction on the line per unstretched length [N/m], p push of the bed [N/m], μ coefficient [-], N unit normal of the bed, w weight
//! in water [N/m]. A point of the line holds on to a place r_h of the bed. Where the spring would pull harder than μ p the line slides, and
//! r_h follows it at the distance at which the spring pulls just so much; r_h is part of the state. δ, a tenth of the diameter d, is the
//! displacement at which a line that only lies on the bed breaks away. No velocity comes in: nothing creeps.
//!
//! Statics does not know how the line came to lie as it lies. It is taken to have been laid slack along the bed, from its anchor on, and
//! then pulled tight: r_h is where the line would lie unstretched. The friction then acts along the line against the pull, and the tension
//! falls by μ p per metre until nothing is left of it (Jonkman 2007). There k_t is 16 EA/l² (l element length), which blurs the place where
//! the tension ends over a quarter of an element. The places r_h with which a run begins are those that give the same friction. In time
//! the bound is 1 % higher, 1.01 μ p: else all of a line at rest would be about to slide, and would, a little with every step, on what the
//! iteration leaves unbalanced.
//!
//! An element holds on at its three Gauss points, whatever part of it touches. The push that counts at each is that on its part of the
//! element, integrated exactly, so that the friction on the line is μ times the push on the line, and nothing jumps where it lifts off.

use crate::rod::ends::Ends;
use crate::rod::mesh::Mesh;
use crate::rod::seabed::Plane;
use nalgebra::{Matrix3, Vector2, Vector3};

/// δ/d.
const BREAKAWAY: f64 = 0.1;
/// Over how much of an element the end of the tension is blurred in statics.
const BLUR: f64 = 0.25;

/// By how much the bound in time exceeds that in statics.
const MARGIN: f64 = 0.01;

/// Friction on one element.
#[derive(Debug, Clone, Copy)]
struct Grip {
    /// k_t that acts [Pa].
    stiffness: f64,
    /// k_t for which r_h is kept [Pa].
    kept: f64,
    /// δ [m].
    breakaway: f64,
}

/// Friction on a line.
#[derive(Debug, Clone)]
pub struct Friction {
    /// Bound over push [-].
    coefficient: f64,
    /// Two unit vectors along the bed.
    axes: [Vector3<f64>; 2],
    grips: Vec<Grip>,
}

/// A part of an element on the bed, and the point at which it holds on.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// P r, along the axes of the bed [m].
    pub place: Vector2<f64>,
    /// p, mean over the part [N/m].
    pub push: f64,
    /// r_h, along the axes of the bed [m].
    pub hold: Vector2<f64>,
}

/// Change of the friction at a point.
#[derive(Debug, Clone, Copy)]
pub struct FrictionTangent {
    /// ∂f/∂r at constant push [Pa].
    pub by_position: Matrix3<f64>,
    /// ∂f/∂p [-].
    pub by_push: Vector3<f64>,
}

impl Friction {
    /// Friction with a coefficient μ > 0 on the elements of a mesh.
    pub fn new(coefficient: f64, plane: &Plane, mesh: &Mesh) -> Friction {
        let along_x = (Vector3::x() - plane.normal * plane.normal.x).normalize();
        let grip = |e: usize| {
            let properties = mesh.properties_of(e);
            let breakaway = BREAKAWAY * properties.diameter;
            let stiffness = coefficient * properties.sinking_weight() / breakaway;
            Grip { stiffness, kept: stiffness, breakaway }
        };
        let grips = (0..mesh.elements.len()).map(grip).collect();
        Friction { coefficient: (1.0 + MARGIN) * coefficient, axes: [along_x, plane.normal.cross(&along_x)], grips }
    }

    /// The friction of statics on the elements of a mesh.
    pub fn laid(mut self, mesh: &Mesh) -> Friction {
        self.coefficient /= 1.0 + MARGIN;
        for (e, grip) in self.grips.iter_mut().enumerate() {
            let length = mesh.elements[e].length;
            // A joint has no length and holds on to nothing.
            grip.stiffness = if length > 0.0 { mesh.properties_of(e).ea / (BLUR * length).powi(2) } else { 0.0 };
        }
        self
    }

    /// Largest friction over push [-].
    pub fn coefficient(&self) -> f64 {
        self.coefficient
    }

    /// Two unit vectors along the bed, at right angles.
    pub fn axes(&self) -> [Vector3<f64>; 2] {
        self.axes
    }

    /// k_t of element `e` [Pa].
    pub fn stiffness(&self, e: usize) -> f64 {
        self.grips[e].stiffness
    }

    /// k_t for which r_h of element `e` is kept [Pa].
    pub fn kept(&self, e: usize) -> f64 {
        self.grips[e].kept
    }

    /// δ of the thinnest element [m].
    pub fn breakaway(&self) -> f64 {
        self.grips.iter().map(|grip| grip.breakaway).fold(f64::INFINITY, f64::min)
    }

    /// A vector along the axes of the bed.
    pub fn along(&self, r: &Vector3<f64>) -> Vector2<f64> {
        Vector2::new(self.axes[0].dot(r), self.axes[1].dot(r))
    }

    /// End values and slopes of an element along each axis of the bed.
    pub fn profiles(&self, ends: &Ends<f64>) -> [[f64; 4]; 2] {
        let parts = ends.parts();
        self.axes.map(|axis| parts.map(|part| part.along(&axis)))
    }

    /// A vector from its components along the axes of the bed.
    pub fn in_space(&self, x: &Vector2<f64>) -> Vector3<f64> {
        self.axes[0] * x.x + self.axes[1] * x.y
    }

    /// Pull of the spring [N/m], and the size from which on the line slides.
    fn pull(&self, e: usize, at: &Contact) -> (Vector2<f64>, f64) {
        ((at.place - at.hold) * -self.grips[e].stiffness, self.coefficient * at.push)
    }

    /// Friction at a point of element `e`, along the axes of the bed [N/m].
    pub fn force(&self, e: usize, at: &Contact) -> Vector2<f64> {
        let (pull, bound) = self.pull(e, at);
        let size = pull.norm();
        if size > bound { pull * (bound / size) } else { pull }
    }

    /// Its tangent.
    pub fn tangent(&self, e: usize, at: &Contact) -> FrictionTangent {
        let stiffness = self.grips[e].stiffness;
        let (pull, bound) = self.pull(e, at);
        let size = pull.norm();
        let projector: Matrix3<f64> = self.axes.iter().map(|axis| axis * axis.transpose()).sum();
        if size > bound {
            let back = self.in_space(&(pull / size));
            let by_position = (projector - back * back.transpose()) * (-stiffness * bound / size);
            FrictionTangent { by_position, by_push: back * self.coefficient }
        } else {
            FrictionTangent { by_position: projector * -stiffness, by_push: Vector3::zeros() }
        }
    }

    /// Place to which a point of element `e` holds on after a step: where the spring in time gives the friction that acts now.
    pub fn hold(&self, e: usize, at: &Contact) -> Vector2<f64> {
        at.place + self.force(e, at) / self.grips[e].kept
    }
}
