//! Which scheme goes by which name.

use crate::scene::types;
use crate::solve::adams_moulton::AdamsMoulton;
use crate::solve::esdirk::{ARK3, Esdirk};
use crate::solve::generalized_alpha::GeneralizedAlpha;
use crate::solve::scheme::Scheme;

/// The scheme of a name, with room for `nodes` nodes.
pub fn of(name: types::Scheme, nodes: usize) -> Box<dyn Scheme> {
    match name {
        types::Scheme::AdamsMoulton | types::Scheme::Cable1994 => Box::new(AdamsMoulton::new(nodes)),
        types::Scheme::Esdirk3 => Box::new(Esdirk::new(&ARK3, nodes)),
        types::Scheme::GeneralizedAlpha => Box::new(GeneralizedAlpha::new(nodes)),
    }
}
