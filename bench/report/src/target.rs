//! What a figure has to be.

use super::{Table, Text, digits, t};

/// On which side of its bounds a figure has to lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// The less the better.
    AtMost,
    /// The more the better.
    AtLeast,
}

/// A figure with its bounds.
#[derive(Clone, Debug)]
pub struct Target {
    /// Number of the target.
    pub id: &'static str,
    /// What the figure is.
    pub what: Text,
    /// On which side it has to lie.
    pub sense: Sense,
    /// Must be reached.
    pub must: f64,
    /// Is hoped for.
    pub stretch: f64,
    /// What was measured; `NaN` for nothing.
    pub value: f64,
    /// Unit of all three; empty for a ratio.
    pub unit: &'static str,
}

impl Target {
    /// A ratio that has to be small.
    #[must_use]
    pub fn at_most(id: &'static str, what: Text, must: f64, stretch: f64, value: f64) -> Self {
        Self { id, what, sense: Sense::AtMost, must, stretch, value, unit: "" }
    }

    /// A ratio that has to be large.
    #[must_use]
    pub fn at_least(id: &'static str, what: Text, must: f64, stretch: f64, value: f64) -> Self {
        Self { sense: Sense::AtLeast, ..Self::at_most(id, what, must, stretch, value) }
    }

    /// Gives the figure a unit.
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

    /// Whether what must be reached is.
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

/// Targets as a table.
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
