//! `coordinates:` and `stores:`: where positions are measured, and where things are kept.

use super::common::{COMMON, TEXT};
use super::form::Bool;

grammar! {
    /// A coordinate system. Structs whose values are given in it say so with `coordinates`.
    /// 一个坐标系。数值以它为准的结构用 `coordinates` 指明。
    _: CoordinateSystem = "coordinate system" "坐标系" {
        use TEXT.zh, TEXT.en, COMMON.about;
    }

    /// A place where things are kept, such as a configuration file. What is kept there says so with `kept`.
    /// 一处保存内容的地方，例如一个配置文件。保存在那里的内容用 `kept` 指明。
    STORE: Store = "store" "存储位置" {
        use TEXT.zh, TEXT.en, COMMON.about;
        /// Whether what is kept there is still there after a restart; left out where that is not known.
        /// 重启后内容是否还在；不清楚时不写。
        optional survives_restart: Bool;
    }
}
