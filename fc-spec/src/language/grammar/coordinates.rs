//! `coordinates:` and `stores:`: coordinate systems, and the stores of values.

use super::common::{COMMON, TEXT};
use super::form::Bool;

grammar! {
    /// A coordinate system. Structs with positions in it name it in `coordinates`.
    /// 一个坐标系。数值以它为准的结构用 `coordinates` 指明。
    _: CoordinateSystem = "coordinate system" "坐标系" {
        use TEXT.zh, TEXT.en, COMMON.about;
    }

    /// A store, such as a configuration file. Operations, fields and tables name it in `kept`.
    /// 一个存储位置，例如一个配置文件。接口、字段和常量表用 `kept` 指明。
    STORE: Store = "store" "存储位置" {
        use TEXT.zh, TEXT.en, COMMON.about;
        /// `true` if its content survives a restart; leave it out if that is unknown.
        /// 写 `true` 表示重启后内容还在；不清楚时不写。
        optional survives_restart: Bool;
    }
}
