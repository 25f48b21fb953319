//! The effects that commands may have on a robot.

use crate::error::InputError;
use fc_spec::model::{Effect, Kind, Operation, Side};
use fc_spec::text;

/// The largest effect that a command may have. The order is that of the danger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Permission {
    /// No effect.
    #[default]
    Read,
    /// Changes of stored values.
    Config,
    /// Motions, and commands of unknown effect.
    Motion,
}

impl Permission {
    /// Returns the permission that an effect needs. An unknown effect counts as a motion.
    #[must_use]
    pub fn for_effect(effect: Effect) -> Self {
        match effect {
            Effect::Read => Self::Read,
            Effect::Config => Self::Config,
            Effect::Motion | Effect::Unknown => Self::Motion,
        }
    }

    /// Refuses an operation with a larger effect. Bytes for no known operation have an unknown effect.
    ///
    /// # Errors
    /// [`InputError`] with the option of `fcproto` that allows the operation.
    pub fn check(self, operation: Option<&Operation>) -> Result<(), InputError> {
        let effect = match operation {
            Some(operation) if operation.kind() != Kind::Stream => operation.effect(),
            // Receiving changes nothing.
            Some(operation) if operation.sender == Side::Robot => Some(Effect::Read),
            Some(_) | None => None,
        };
        let effect = effect.unwrap_or(Effect::Unknown);
        let needed = Self::for_effect(effect);
        if needed <= self {
            return Ok(());
        }
        let name = operation.map_or("--raw", |operation| &operation.name);
        let effect = effect.name();
        let option = match needed {
            Self::Read | Self::Config => "--allow config",
            Self::Motion => "--allow motion",
        };
        Err(InputError(text!(
            "`{name}` 的影响是 `{effect}`，没有发送；确定要发送就加 `{option}`",
            "`{name}` has the effect `{effect}` and was not sent; add `{option}` to send it"
        )))
    }
}
