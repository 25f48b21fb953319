//! `entities:`: the kinds of things with ids.

use super::common::TEXT;

grammar! {
    /// A kind of thing with ids, such as stations or maps. Fields that hold its ids name it in `refers`.
    /// 一类有 ID 的东西，例如站点、地图。值是它的 ID 的字段用 `refers` 指明。
    _: Entity = "entity" "实体" {
        use TEXT.zh, TEXT.en;
    }
}
