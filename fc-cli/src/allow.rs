//! The option `--allow`.

use clap::ValueEnum;
use fc_spec::model::Effect;

use crate::lang::both;

/// The largest effect that a command may have. The order is that of the danger.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Allowed {
    #[value(help = both("改变机器人保存的内容", "Change what the robot stores"))]
    Config,
    #[value(help = both("也让机器人运动，以及影响未知的指令", "Also move the robot, and commands of unknown effect"))]
    Motion,
}

impl Allowed {
    /// Returns the option that an effect needs, or `None` if it needs none. An unknown effect counts as a motion.
    pub fn needed(effect: Effect) -> Option<Self> {
        match effect {
            Effect::Read => None,
            Effect::Config => Some(Self::Config),
            Effect::Motion | Effect::Unknown => Some(Self::Motion),
        }
    }

    /// Returns the option as a person writes it.
    pub fn option(self) -> &'static str {
        match self {
            Self::Config => "--allow config",
            Self::Motion => "--allow motion",
        }
    }
}
