//! Targets: figures with bounds.

use super::{Table, Text, digits, t};

/// The good direction of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// Less is better.
    AtMost,
    /// More is better.
    AtLeast,
}

/// A figure with its bounds.
#[derive(Clone, Debug)]
pub struct Target {
    /// Number of the target.
    pub id: &'static str,
    /// Description of the figure.
    pub what: Text,
    /// Good direction of the figure.
    pub sense: Sense,
    /// Bound that must be reached.
    pub must: f64,
    /// Better bound, which is optional.
    pub stretch: f64,
    /// Measured figure, or `NaN` if it was not measured.
    pub value: f64,
    /// Unit of the figure and its bounds. It is empty for a ratio.
    pub unit: &'static str,
}

impl Target {
    /// Creates a target for a ratio that must be small.
    #[must_use]
    pub fn at_most(id: &'static str, what: Text, must: f64, stretch: f64, value: f64) -> Self {
        Self { id, what, sense: Sense::AtMost, must, stretch, value, unit: "" }
    }

    /// Creates a target for a ratio that must be large.
    #[must_use]
    pub fn at_least(id: &'static str, what: Text, must: f64, stretch: f64, value: f64) -> Self {
        Self { sense: Sense::AtLeast, ..Self::at_most(id, what, must, stretch, value) }
    }

    /// Sets the unit.
    #[must_use]
    pub fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    fn reaches(&self, bound: f64) -> bool {
        match self.sense {
            Sense::AtMost => self.value <= bound,
            Sense::AtLeast => self.value >= bound,
        }
    }

    /// Returns `true` if the figure reaches the bound `must`.
    #[must_use]
    pub fn is_met(&self) -> bool {
        self.reaches(self.must)
    }

    fn verdict(&self) -> Text {
        if self.value.is_nan() {
            t("未测", "not measured")
        } else if !self.is_met() {
            t("**未达标**", "**missed**")
        } else if self.reaches(self.stretch) {
            t("达到理想值", "stretch reached")
        } else {
            t("达标", "met")
        }
    }

    fn bound(&self, bound: f64) -> Text {
        let sign = match self.sense {
            Sense::AtMost => "≤",
            Sense::AtLeast => "≥",
        };
        format!("{sign} {}{}", digits(bound), self.unit).into()
    }
}

/// Returns targets as a table.
#[must_use]
pub fn table(targets: &[Target]) -> Table {
    let columns = vec![
        t("目标", "target"),
        t("内容", "what"),
        t("必须", "must"),
        t("理想", "stretch"),
        t("实测", "measured"),
        t("结论", "verdict"),
    ];
    let mut table = Table::new(t("目标", "Targets"), columns);
    for target in targets {
        table.row(vec![
            target.id.into(),
            target.what.clone(),
            target.bound(target.must),
            target.bound(target.stretch),
            format!("{}{}", digits(target.value), target.unit).into(),
            target.verdict(),
        ]);
    }
    table
}
