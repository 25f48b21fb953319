//! The option `--allow`.

use clap::ValueEnum;
use fc_spec::model::{Effect, Kind, Operation, Side};

use crate::lang::{both, said};
use crate::outcome::Failure;

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

/// Refuses an operation with a larger effect than allowed. An unknown effect counts as a motion.
pub fn check(operation: Option<&Operation>, allowed: Option<Allowed>) -> Result<(), Failure> {
    let effect = match operation {
        Some(operation) if operation.kind() != Kind::Stream => operation.effect(),
        // Receiving changes nothing.
        Some(operation) if operation.sender == Side::Robot => Some(Effect::Read),
        Some(_) | None => None,
    };
    let effect = effect.unwrap_or(Effect::Unknown);
    let Some(needed) = Allowed::needed(effect).filter(|needed| allowed < Some(*needed)) else {
        return Ok(());
    };
    let name = operation.map_or("--raw", |operation| &operation.name);
    let effect = effect.name();
    let option = needed.option();
    Err(said!(
        "`{name}` 的影响是 `{effect}`，没有发送；确定要发送就加 `{option}`",
        "`{name}` has the effect `{effect}` and was not sent; add `{option}` to send it"
    )
    .into())
}
