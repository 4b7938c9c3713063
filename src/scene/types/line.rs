//! The part `lines` of a scene: lines and their sections.

use crate::scene::bodies::{End, Mount};
use crate::scene::types::point::{Attachment, Constraint};
use crate::scene::types::vector::Triple;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One mooring line from fairlead to anchor. Both ends are pinned, unless a constraint says otherwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "LineKeys", into = "LineKeys")]
pub struct Line {
    /// Name, unique in the scene.
    pub name: String,
    /// Position of the fairlead at the start [m].
    pub fairlead: Triple,
    /// What the fairlead hangs on; none: on nothing but its coordinates.
    pub fairlead_on: Option<Mount>,
    /// Position of the anchor at the start [m].
    pub anchor: Triple,
    /// What the anchor hangs on; none: on nothing but its coordinates.
    pub anchor_on: Option<Mount>,
    /// Sections from fairlead to anchor, at least one.
    pub sections: Vec<Section>,
    /// Clump weights and buoys.
    pub attachments: Vec<Attachment>,
    /// Springs, dampers, locked directions, dead forces and masses at points of the line.
    pub constraints: Vec<Constraint>,
}

/// One mooring line from fairlead to anchor. Both ends are pinned, unless a constraint says otherwise.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Line")]
struct LineKeys {
    /// Name, unique among lines, bodies and points. Default: `line1`, `line2`, … by position.
    #[serde(default)]
    name: String,
    /// Position of the fairlead at the start [m], or what it hangs on.
    fairlead: End,
    /// Position of the anchor [m], or what it hangs on.
    anchor: End,
    /// Sections from fairlead to anchor, at least one.
    #[schemars(length(min = 1))]
    sections: Vec<Section>,
    /// Clump weights and buoys. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("default" = []))]
    attachments: Vec<Attachment>,
    /// Springs, dampers, locked directions, dead forces and masses at points of the line. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("default" = []))]
    constraints: Vec<Constraint>,
}

impl From<LineKeys> for Line {
    fn from(keys: LineKeys) -> Line {
        let LineKeys { name, fairlead, anchor, sections, attachments, constraints } = keys;
        let parted = |end| match end {
            End::At(at) => (at, None),
            End::On(mount) => ([0.0; 3], Some(mount)),
        };
        let ((fairlead, fairlead_on), (anchor, anchor_on)) = (parted(fairlead), parted(anchor));
        Line { name, fairlead, fairlead_on, anchor, anchor_on, sections, attachments, constraints }
    }
}

impl From<Line> for LineKeys {
    fn from(line: Line) -> LineKeys {
        let Line { name, fairlead, fairlead_on, anchor, anchor_on, sections, attachments, constraints } = line;
        let joined = |at: Triple, on: Option<Mount>| on.map_or(End::At(at), End::On);
        let (fairlead, anchor) = (joined(fairlead, fairlead_on), joined(anchor, anchor_on));
        LineKeys { name, fairlead, anchor, sections, attachments, constraints }
    }
}

impl JsonSchema for Line {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        LineKeys::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        LineKeys::json_schema(generator)
    }
}

/// A stretch of one line type.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Name of a line type.
    #[serde(rename = "type")]
    pub line_type: String,
    /// Unstretched length [m], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub length: f64,
    /// Number of equal elements, ≥ 1. Default: chosen by the program to meet the tolerance. A section that an attachment or constraint
    /// divides shares them out among its parts, at least one each.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 20000))]
    pub elements: Option<usize>,
}

/// Points of a line nearer to each other than this share of its length are one.
pub const SAME_PLACE: f64 = 1.0e-9;

impl Line {
    /// Where the scene puts the end at arc length `s` from the fairlead; none if that is no end.
    pub fn end_at(&self, s: f64) -> Option<Triple> {
        let (length, near) = (self.length(), SAME_PLACE * self.length());
        if s <= near {
            Some(self.fairlead)
        } else if s >= length - near {
            Some(self.anchor)
        } else {
            None
        }
    }

    /// Whether nothing but a pin holds the end at arc length `s`, where there is one.
    pub fn is_pinned(&self, s: f64) -> bool {
        let near = SAME_PLACE * self.length();
        !self.constraints.iter().any(|constraint| (constraint.s - s).abs() <= near && !constraint.is_pin())
    }

    /// Unstretched length [m].
    pub fn length(&self) -> f64 {
        self.sections.iter().map(|section| section.length).sum()
    }
}
