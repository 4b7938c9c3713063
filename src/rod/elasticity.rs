//! Tension as a function of strain: Hooke's law, or a table and the pressures on the wall of a pipe.
//!
//! ```text
//! T(e) = EA e                                               (`Hooke`)
//! T(e) = S_0 e + Σ_k (S_k - S_{k-1}) max(0, e - e_k) + p_o A_o - p_i A_i          (`Tabulated`)
//! p_o = ρ g max(0, -z),   p_i = p_t + ρ_i g (z_t - z)
//! ```
//!
//! T effective tension [N], e strain of the wall [-], S_k slopes of the table between its points [N], A_o, A_i outer and inner area
//! [m²], p_o, p_i pressures [Pa] of the water and of the fluid inside, p_t the latter at the height z_t of the fairlead in the
//! scene. The tension of the wall is T - p_o A_o + p_i A_i. Beyond its last point a table goes on with its last slope.

use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::rod::axial::Axial;
use crate::rod::properties::Properties;
use crate::scene::types::{Environment, LineType};

/// What the tension of a section depends on besides EA.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Elasticity {
    /// Strain [-] and tension [N], rising from [0, 0].
    pub table: Option<Vec<[f64; 2]>>,
    /// Pressures on its wall, where they are asked for or there is a fluid inside.
    pub pressures: Option<Pressures>,
    /// Whether the pressures strain it.
    pub strained: bool,
}

/// Pressures on the wall of a section.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pressures {
    /// ρ g A_o [N/m].
    pub outer: f64,
    /// ρ_i g A_i [N/m].
    pub inner: f64,
    /// p_i A_i at z = 0 [N].
    pub inner_at_zero: f64,
}

impl Pressures {
    /// Pressures on a line type in an environment; `top`: height of the fairlead [m].
    pub fn of(line_type: &LineType, environment: &Environment, top: f64) -> Pressures {
        let (rho, gravity) = (environment.water_density, environment.gravity);
        let displaced = line_type.mass * gravity - line_type.weight_in_water(rho, gravity);
        let outer = line_type.outer_area.map_or(displaced, |area| rho * gravity * area);
        let fluid = line_type.inner_fluid.as_ref();
        let inner = fluid.map_or(0.0, |fluid| fluid.density * gravity * fluid.area);
        let at_top = fluid.map_or(0.0, |fluid| fluid.pressure * fluid.area);
        Pressures { outer, inner, inner_at_zero: at_top + inner * top }
    }

    /// p_o A_o - p_i A_i at height z [N]: effective tension less that of the wall.
    pub fn force(&self, z: f64) -> f64 {
        self.outer * (-z).max(0.0) - (self.inner_at_zero - self.inner * z)
    }
}

impl Elasticity {
    /// The same with all tensions of the table `factor` times as large.
    pub fn scaled(&self, factor: f64) -> Elasticity {
        let scaled = |table: &Vec<[f64; 2]>| table.iter().map(|[strain, tension]| [*strain, tension * factor]).collect();
        Elasticity { table: self.table.as_ref().map(scaled), ..self.clone() }
    }

    /// Whether the tension is more than EA e.
    pub fn is_special(&self) -> bool {
        self.table.is_some() || self.strained
    }

    fn straining(&self) -> Option<&Pressures> {
        self.pressures.as_ref().filter(|_| self.strained)
    }
}

/// How the tension of a line follows from its strain.
pub trait Elastic: Copy + Send + Sync + 'static {
    /// True: the element loop looks up tension and stiffness of every point before it asks for them.
    const SPECIAL: bool;
    /// T(e) [N].
    fn tension<F: Real>(law: &Axial<F>, strain: F) -> F;
    /// dT/de [N].
    fn stiffness<F: Real>(law: &Axial<F>) -> F;
}

/// Hooke's law.
#[derive(Debug, Clone, Copy)]
pub struct Hooke;

impl Elastic for Hooke {
    const SPECIAL: bool = false;
    #[inline(always)]
    fn tension<F: Real>(law: &Axial<F>, strain: F) -> F {
        law.ea * strain
    }
    #[inline(always)]
    fn stiffness<F: Real>(law: &Axial<F>) -> F {
        law.ea
    }
}

/// A table, pressures, or both.
#[derive(Debug, Clone, Copy)]
pub struct Tabulated;

impl Elastic for Tabulated {
    const SPECIAL: bool = true;
    #[inline(always)]
    fn tension<F: Real>(law: &Axial<F>, _: F) -> F {
        law.elastic
    }
    #[inline(always)]
    fn stiffness<F: Real>(law: &Axial<F>) -> F {
        law.stiffness
    }
}

/// The tables and pressures of all elements, one row per number, padded like the table of properties.
#[derive(Debug, Clone, Default)]
pub struct Curves {
    first_slope: Vec<f64>,
    /// Strain e_k and change of slope there.
    knees: Vec<[Vec<f64>; 2]>,
    outer: Vec<f64>,
    inner: Vec<f64>,
    inner_at_zero: Vec<f64>,
}

impl Curves {
    /// The curves of elements, given what the tension of each depends on.
    pub fn new(elements: &[(&Elasticity, &Properties)]) -> Curves {
        let count = elements.len();
        let row = |value: &dyn Fn(usize) -> f64| {
            let mut row = vec![0.0; padded(count + 1) + MOST_LANES];
            (0..count).for_each(|e| row[e] = value(e));
            row
        };
        let slopes: Vec<Vec<[f64; 2]>> = elements.iter().map(|(elasticity, properties)| slopes(elasticity, properties)).collect();
        let most = slopes.iter().map(Vec::len).max().unwrap_or(1);
        let knee = |k: usize| {
            let at = |e: usize| slopes[e].get(k).map_or(0.0, |[strain, _]| *strain);
            let change = |e: usize| slopes[e].get(k).map_or(0.0, |[_, slope]| slope - slopes[e][k - 1][1]);
            [row(&at), row(&change)]
        };
        let pressure = |of: fn(&Pressures) -> f64| row(&|e| elements[e].0.straining().map_or(0.0, of));
        Curves {
            first_slope: row(&|e| slopes[e][0][1]),
            knees: (1..most).map(knee).collect(),
            outer: pressure(|p| p.outer),
            inner: pressure(|p| p.inner),
            inner_at_zero: pressure(|p| p.inner_at_zero),
        }
    }

    /// Tension [N] and stiffness [N] of the elements from `e` on at a strain and height.
    #[inline(always)]
    pub fn at<F: Real>(&self, cpu: F::Cpu, e: usize, strain: F, z: F) -> (F, F) {
        let zero = F::splat(cpu, 0.0);
        let mut stiffness = F::load(cpu, &self.first_slope, e);
        let mut tension = stiffness * strain;
        for [at, change] in &self.knees {
            let (beyond, change) = (strain - F::load(cpu, at, e), F::load(cpu, change, e));
            tension = change.mul_add(beyond.max(zero), tension);
            stiffness = change.mul_add(beyond.positive(), stiffness);
        }
        let water = F::load(cpu, &self.outer, e) * (-z).max(zero);
        let inside = F::load(cpu, &self.inner_at_zero, e) - F::load(cpu, &self.inner, e) * z;
        (tension + water - inside, stiffness)
    }
}

/// Where each slope of a table begins, and the slope [N].
fn slopes(elasticity: &Elasticity, properties: &Properties) -> Vec<[f64; 2]> {
    match &elasticity.table {
        Some(table) if table.len() > 1 => {
            table.windows(2).map(|pair| [pair[0][0], (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])]).collect()
        }
        _ => vec![[0.0, properties.ea]],
    }
}
