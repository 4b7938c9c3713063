//! A line of mixed elements: its tensions, its equations in band form, and the forces at its nodes.
//!
//! Eight unknowns per node: position, slope r', λ at the node, λ in the middle of the element that follows (the last one is idle).

use crate::algebra::banded::Banded;
use crate::cable1994::element::{self, Element, Instant, Terms};
use crate::cable1994::shapes::Integrals;
use crate::rod::line::Supports;
use crate::rod::state::{Field, State};
use crate::sea::current::Current;
use nalgebra::Vector3;

/// Unknowns per node.
pub const UNKNOWNS: usize = 8;
/// An element ties the unknowns of two nodes.
const HALF_BAND: usize = 2 * UNKNOWNS - 1;

/// A line of mixed elements, from the anchor to the fairlead. Positions and slopes belong to the caller.
pub struct MixedLine {
    pub(super) elements: Vec<Element>,
    pub(super) current: Option<Current>,
    pub(super) supports: Supports,
    pub(super) integrals: Integrals,
    pub(super) system: Banded,
    /// λ [N] and what it was a step before.
    pub tensions: Tensions,
}

/// λ at the nodes and in the middle of the elements, now and one step before.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tensions {
    /// Two numbers per node: λ there and in the middle of the element that follows; the last number is idle [N].
    pub now: Vec<f64>,
    /// The same one step before.
    pub before: Vec<f64>,
}

impl Tensions {
    fn of(&self, e: usize) -> [f64; 3] {
        [self.now[2 * e], self.now[2 * e + 1], self.now[2 * e + 2]]
    }

    /// λ extrapolated by `share` of the last step.
    fn ahead(&self, e: usize, share: f64) -> [f64; 3] {
        std::array::from_fn(|m| {
            let at = 2 * e + m;
            self.now[at] + share * (self.now[at] - self.before[at])
        })
    }
}

impl MixedLine {
    /// A line of given elements, held and loaded at its nodes, in a current.
    pub fn new(elements: Vec<Element>, current: Option<Current>, supports: Supports) -> MixedLine {
        let nodes = elements.len() + 1;
        let rest = vec![0.0; 2 * nodes];
        MixedLine {
            elements,
            current,
            supports,
            integrals: Integrals::new(),
            system: Banded::new(UNKNOWNS * nodes, HALF_BAND),
            tensions: Tensions { now: rest.clone(), before: rest },
        }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.elements.len() + 1
    }

    /// The largest time constant of the damping [s].
    pub fn damping(&self) -> f64 {
        self.elements.iter().map(|element| element.properties.damping).fold(0.0, f64::max)
    }

    /// Whether λ is negative anywhere on a line that cannot bend: the equations have no stable solution there.
    pub fn is_pushing(&self) -> bool {
        let flexible = |e: usize| self.elements[e].properties.ei == 0.0;
        (0..self.elements.len()).any(|e| flexible(e) && self.tensions.of(e).iter().any(|tension| *tension < 0.0))
    }

    /// Terms of element `e` now, with K and its coupling to λ `ahead` seconds later: U there by its rate, λ extrapolated by `share` of
    /// the last step.
    pub(super) fn terms(&self, e: usize, state: &State, ahead: f64, share: f64) -> Terms {
        let element = &self.elements[e];
        let of = |field: &Field| element::ends(field, e, element.length);
        let now = Instant { u: of(&state.u), v: of(&state.v), tension: self.tensions.of(e) };
        let u = std::array::from_fn(|k| now.u[k] + now.v[k] * ahead);
        let half = Instant { u, tension: self.tensions.ahead(e, share), ..now };
        element.terms(&self.integrals, self.current.as_ref(), &now, &half)
    }

    /// Force [N] that the fairlead side exerts on the anchor side at a node, λ r' - EI r''', for λ as in `Tensions`.
    pub fn node_force(&self, u: &Field, tensions: &[f64], node: usize) -> Vector3<f64> {
        let mut force = u.slope(node) * tensions[2 * node];
        let sides = [node.checked_sub(1), Some(node)].into_iter().flatten();
        let stiff = |e: &usize| self.elements.get(*e).is_some_and(|element| element.properties.ei > 0.0);
        let shared = if node == 0 || node == self.elements.len() { 1.0 } else { 0.5 };
        for e in sides.filter(stiff) {
            let Element { length, properties, .. } = &self.elements[e];
            let [r0, p0, r1, p1] = element::ends(u, e, *length);
            let third = ((r0 - r1) * 12.0 + (p0 + p1) * 6.0) / length.powi(3);
            force -= third * (properties.ei * shared);
        }
        force
    }

    /// Adds the terms of element `e` to the system of a step of length h, z = δu - h u̇; in statics h is 0 and inertia left out. The
    /// change of the water's pressure with δz is in the matrix in statics only.
    pub(super) fn scatter(&mut self, e: usize, terms: &Terms, state: &State, h: f64) {
        let element = &self.elements[e];
        let (length, system) = (element.length, &mut self.system);
        let v = element::ends(&state.v, e, length);
        let (inertia, times) = if h > 0.0 { (4.0 / (h * h), 2.0) } else { (0.0, 1.0) };
        let factor = if h > 0.0 { 1.0 - element.properties.damping / h } else { 1.0 };
        // Row of the first component of an end, and what makes r' of L r'.
        let place = |k: usize| (UNKNOWNS * (e + k / 2) + 3 * (k % 2), if k % 2 == 1 { length } else { 1.0 });
        let tension = |m: usize| UNKNOWNS * e + [6, 7, UNKNOWNS + 6][m];
        for i in 0..4 {
            let (row, unit) = place(i);
            for k in 0..4 {
                let (column, per) = place(k);
                let mut block = terms.mass[i][k] * inertia;
                let elastic = terms.stiffness[i][k];
                (0..3).for_each(|c| block[(c, c)] += elastic);
                block[(2, 2)] += terms.push.stiffness[i][k];
                for (r, c) in (0..3).flat_map(|r| (0..3).map(move |c| (r, c))) {
                    system.add(row + r, column + c, block[(r, c)] * unit * per);
                }
                (0..3).for_each(|c| system.right[row + c] -= h * elastic * v[k][c] * unit);
                system.right[row + 2] -= h * terms.push.stiffness[i][k] * v[k].z * unit;
            }
            for c in 0..3 {
                system.right[row + c] += times * terms.force[i][c] * unit;
                for m in 0..3 {
                    system.add(row + c, tension(m), terms.coupling[i][m][c] * unit);
                    system.add(tension(m), row + c, terms.coupling[i][m][c] * unit);
                }
            }
            if h == 0.0 {
                (0..3).for_each(|m| system.add(tension(m), row + 2, -terms.squeeze[i][m] * unit));
            }
            (0..3).for_each(|m| system.right[tension(m)] -= h * terms.coupling[i][m].dot(&v[i]));
        }
        for m in 0..3 {
            system.right[tension(m)] += terms.strain[m];
            (0..3).for_each(|n| system.add(tension(m), tension(n), -factor * terms.compliance[n][m]));
        }
        if e + 1 == self.elements.len() {
            let idle = UNKNOWNS * (e + 1) + 7;
            system.add(idle, idle, 1.0);
        }
    }

    /// Adds the dead loads, times a factor.
    pub(super) fn load(&mut self, times: f64) {
        for (node, force) in &self.supports.loads {
            (0..3).for_each(|c| self.system.right[UNKNOWNS * node + c] += times * force[c]);
        }
    }
}
