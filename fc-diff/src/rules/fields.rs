//! Fields and their types.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, JvmBinary, Kotlin, Python, Rust, Typescript};
use crate::rule::{Language, Rule, Wire};

/// Languages with several number types.
const NUMBERS: &[Language] = &[Rust, Kotlin, JvmBinary, Cpp, Typescript];

rules! {
    REQUIRED_ADDED {
        number: 25,
        name: "required-field-added",
        wire: Wire::OldSender,
        source: &[Rust, Python, Typescript],
        mirror: &[27],
        title: ["a required field is new", "新增必填字段"],
        text: [
            "Old senders do not send it, and new receivers refuse the message. Programs in Kotlin and C++ compile without the \
             field. In Kotlin the message cannot be built, and in C++ it is not sent. Make it optional, with a default.",
            "旧发送方不发这个字段，新接收方会拒绝。Kotlin 和 C++ 的代码不写这个字段也能编译：Kotlin 在构造消息时报错，C++ 中消息不会发出。请改为可选，并说明缺省含义。",
        ],
    }
    OPTIONAL_ADDED {
        number: 26,
        name: "optional-field-added",
        mirror: &[28],
        title: ["an optional field is new", "新增可选字段"],
        text: [
            "Messages and programs work as before. In C++, a new field before other fields moves them; FC0777 reports that.",
            "报文不受影响，代码照常编译。C++ 中新字段若在其他字段之前，会改变它们的位置，由 FC0777 提示。",
        ],
    }
    REQUIRED_REMOVED {
        number: 27,
        name: "required-field-removed",
        wire: Wire::NewSender,
        source: EVERY,
        mirror: &[25],
        title: ["a required field is gone", "删除了必填字段"],
        text: [
            "Old receivers demand it and refuse messages without it.",
            "旧接收方要求有这个字段，没有就拒绝。",
        ],
    }
    OPTIONAL_REMOVED {
        number: 28,
        name: "optional-field-removed",
        source: EVERY,
        behaviour: true,
        mirror: &[26],
        title: ["an optional field is gone", "删除了可选字段"],
        text: [
            "New receivers ignore the value from old senders. Old receivers read it as absent.",
            "新接收方忽略旧发送方的值；旧接收方当作没有这个字段。",
        ],
    }
    BECAME_REQUIRED {
        number: 29,
        name: "field-became-required",
        wire: Wire::OldSender,
        source: EVERY,
        mirror: &[30],
        title: ["an optional field is required now", "可选字段改为必填"],
        text: [
            "Old senders may leave it out, and new receivers refuse the message.",
            "旧发送方可能不发，新接收方会拒绝。",
        ],
    }
    BECAME_OPTIONAL {
        number: 30,
        name: "field-became-optional",
        wire: Wire::NewSender,
        source: EVERY,
        mirror: &[29],
        title: ["a required field is optional now", "必填字段改为可选"],
        text: [
            "New senders may leave it out, and old receivers refuse the message.",
            "新发送方可能不发，旧接收方会拒绝。",
        ],
    }
    KEY_CHANGED {
        number: 31,
        name: "wire-key-changed",
        wire: Wire::Both,
        silent: true,
        mirror: &[31, 32],
        title: ["a field has another key in messages", "报文中的键名变更"],
        text: [
            "Each version reads a key that the other does not send. A required field is missing. The value of an optional \
             field is lost without an error. Keep the old key in `also`.",
            "双方都读不到自己的键。必填字段会报缺失；可选字段的值会丢失，且不会报错。把旧键名写进 `also`。",
        ],
    }
    KEY_CHANGED_WITH_ALSO {
        number: 32,
        name: "wire-key-changed-with-also",
        wire: Wire::NewSender,
        silent: true,
        mirror: &[31],
        title: ["a field has another key, and the old one is still read", "键名变更，旧键名仍可接收"],
        text: [
            "New receivers read both keys. Old receivers do not know the new one.",
            "新接收方两个键名都能读，旧接收方不认识新键名。",
        ],
    }
    ALSO_REMOVED {
        number: 33,
        name: "also-removed",
        wire: Wire::OldSender,
        silent: true,
        no_mirror: ["reading another key has no effect on programs", "多接收一个键名不影响任何程序"],
        title: ["a further key is no longer read", "不再接收备用键名"],
        text: [
            "Receivers ignore the value of senders that still use this key. If the field is required, they refuse the message.",
            "发送方仍使用该键名时，接收方忽略它的值；若字段必填，接收方拒绝报文。",
        ],
    }
    NAME_CHANGED {
        number: 34,
        name: "code-name-changed",
        source: EVERY,
        mirror: &[34],
        title: ["it has another name in code", "代码中的名称变更"],
        text: [
            "The name of a field, enum value, result, header field or the protocol changed. Messages are the same. Programs that \
             use the old name do not compile. Header fields have names in Rust only.",
            "字段、枚举取值、结果码、包头字段或协议改名。报文不变，引用旧名称的代码无法编译。包头字段只在 Rust 中有名称。",
        ],
    }
    TYPE_CHANGED {
        number: 35,
        name: "type-changed",
        wire: Wire::Both,
        source: EVERY,
        mirror: &[35, 43],
        title: ["it has another type", "类型变更"],
        text: [
            "A receiver refuses a value of another type. The finding names the directions that break. A direction works if the \
             receiver can read every value of the sender's type.",
            "接收方会拒绝类型不符的值。结果中写明了哪个方向不兼容；若一种类型的值都能按另一种读取，该方向不受影响。",
        ],
    }
    NUMBER_WIDENED {
        number: 36,
        name: "integer-widened",
        wire: Wire::NewSender,
        source: NUMBERS,
        mirror: &[37],
        title: ["a number type is wider", "数值类型变宽"],
        text: [
            "New senders may send numbers that the old type cannot hold. A range within the old type prevents that.",
            "新发送方可能发出旧类型放不下的数。若新旧版本的取值范围都在旧类型之内，则不受影响。",
        ],
    }
    NUMBER_NARROWED {
        number: 37,
        name: "integer-narrowed",
        wire: Wire::Both,
        source: NUMBERS,
        mirror: &[36, 37],
        title: ["a number type is narrower or has another sign", "数值类型变窄或符号变更"],
        text: [
            "Old senders may send numbers that the new type cannot hold. With another sign, new senders may also send numbers that \
             the old type cannot hold.",
            "旧发送方可能发出新类型放不下的数。若有无符号也变了，反方向同样可能超出范围。",
        ],
    }
    INTEGER_FLOAT {
        number: 38,
        name: "integer-became-float",
        wire: Wire::Both,
        source: EVERY,
        mirror: &[38],
        title: ["an integer became a float, or the reverse", "整数与浮点数互换"],
        text: [
            "The side that reads integers refuses fractions. The side that reads floats takes integers.",
            "按整数读取的一方会拒绝小数；按浮点数读取的一方可以接收整数。",
        ],
    }
    FORM_CHANGED {
        number: 39,
        name: "wire-form-changed",
        wire: Wire::Both,
        mirror: &[39],
        title: ["a value is sent in another form", "值的发送形式变更"],
        text: [
            "Receivers do not read a number from a string, or the reverse, without a quirk (`lenient_number`, `lenient_bool`).",
            "字符串里的数值与数值本身不能互换，除非接收方有 `lenient_number` 或 `lenient_bool`。",
        ],
    }
    TIME_UNIT {
        number: 40,
        name: "time-unit-changed",
        wire: Wire::Both,
        behaviour: true,
        silent: true,
        mirror: &[40],
        title: ["a time is in another unit", "时间戳单位变更"],
        text: [
            "Milliseconds are read as seconds, or the reverse. Every time is wrong by a factor of 1000, without an error.",
            "毫秒被当作秒，或相反。不会报错，但时间差 1000 倍。",
        ],
    }
    UNIT {
        number: 41,
        name: "unit-changed",
        wire: Wire::Both,
        behaviour: true,
        silent: true,
        mirror: &[41],
        title: ["a number is in another unit", "单位变更"],
        text: [
            "The receiver reads the number in its own unit, and no error occurs. A robot may move 1000 times too far. If the unit \
             in the spec was wrong, accept the change with a waiver. If only one version has a unit, messages do not count as broken.",
            "接收方按自己的单位理解数值，不会报错，机器人移动的距离可能差 1000 倍。如果只是更正规范中的单位，请豁免。若只有一个版本写明单位，不计为报文不兼容。",
        ],
    }
    TYPE_RENAMED {
        number: 42,
        name: "type-renamed",
        source: EVERY,
        mirror: &[42],
        title: ["a type has another name", "类型改名"],
        text: [
            "An inline object got a name, or a type got another name. Messages are the same. Programs with the old name \
             do not compile.",
            "内嵌对象有了名称，或类型改了名。报文不变，引用旧名称的代码无法编译。",
        ],
    }
    JSON_TYPED {
        number: 43,
        name: "json-became-typed",
        wire: Wire::OldSender,
        source: EVERY,
        mirror: &[35],
        title: ["any JSON became a type", "任意 JSON 改为具体类型"],
        text: [
            "Old senders may send any JSON, and new receivers refuse values that do not fit the type.",
            "旧发送方可能发送任意 JSON，新接收方会拒绝不符合类型的值。",
        ],
    }
    COORDINATES {
        number: 74,
        name: "coordinates-changed",
        wire: Wire::Both,
        behaviour: true,
        silent: true,
        mirror: &[74],
        title: ["a position is given in other coordinates", "坐标系变更"],
        text: [
            "The receiver reads the position in its own coordinate system, and no error occurs. If the spec was wrong, accept the \
             change with a waiver. Renaming a coordinate system is not a change of this kind.",
            "接收方按自己的坐标系理解位置，不会报错。如果只是更正规范，请豁免。坐标系改名不属于这种变更。",
        ],
    }
    REFERENCE {
        number: 75,
        name: "reference-changed",
        source: EVERY,
        behaviour: true,
        silent: true,
        mirror: &[75],
        title: ["a field has the ID of something else", "字段改为另一种实体的 ID"],
        text: [
            "The receiver takes the ID for that of another entity, and no error occurs. With `newtypes: true` in `fc.yaml`, the \
             type of the field changes in every package. If the entity was only renamed, the behaviour is the same.",
            "接收方会把 ID 当作另一种实体的 ID，不会报错。若 `fc.yaml` 中设置了 `newtypes: true`，各个包中字段的类型会变。只是实体改名时，行为不变。",
        ],
    }
    REUSED {
        number: 76,
        name: "retired-key-reused",
        wire: Wire::Both,
        silent: true,
        no_mirror: [
            "to give it up again is to remove the field (FC0727, FC0728) or the value (FC0753)",
            "再次放弃，即删除字段（FC0727、FC0728）或枚举取值（FC0753）",
        ],
        title: ["an earlier release used this for something else", "在更早的发布版本中含义不同"],
        text: [
            "An earlier release had this key, enum value or result code. A later release removed it, and now it returns with \
             another meaning. Apps and robots of the earlier release still use the old meaning. Choose another name. If no app and no \
             robot has that release, accept the change with a waiver.",
            "更早的发布版本中用过这个键名、枚举取值或结果码，之后删除，现在以另一种含义恢复。仍在使用那个版本的 app 和机器人会按旧含义处理。\
             请换一个名称。如果已没有 app 和机器人使用那个版本，可以豁免。",
        ],
    }
    MEMBER_ORDER {
        number: 77,
        name: "member-order-changed",
        source: &[Cpp],
        // The finding about the removed field covers this change.
        mirror: &[77, 27, 28],
        title: ["fields of a struct have other positions", "结构体字段的位置变更"],
        text: [
            "Structs in C++ are aggregates. A program that initialises one by position assigns its values to other fields, often \
             without an error. Other languages use names, and keys in messages have no order. Add new fields at the end.",
            "C++ 的结构体是聚合类型，按位置初始化的代码会把值赋给别的字段，往往不会报错。其他语言按名称赋值，报文中的键没有顺序。新字段请加在最后。",
        ],
    }
}
