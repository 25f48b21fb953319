//! The option `--allow`.

use clap::ValueEnum;
use fc_workshop::permission::Permission;

use crate::lang::both;

/// The largest effect that a command may have. The order is that of the danger.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Allowed {
    #[value(help = both("改变机器人保存的内容", "Change what the robot stores"))]
    Config,
    #[value(help = both("也让机器人运动，以及影响未知的指令", "Also move the robot, and commands of unknown effect"))]
    Motion,
}

/// Returns the permission of a command line.
pub fn permission(allowed: Option<Allowed>) -> Permission {
    match allowed {
        None => Permission::Read,
        Some(Allowed::Config) => Permission::Config,
        Some(Allowed::Motion) => Permission::Motion,
    }
}
