//! Frame and transport.

use super::{BASE, rules};
use crate::rule::Language::Rust;
use crate::rule::{Rule, Wire};

rules! {
    PORT_NUMBER {
        number: 1,
        name: "port-number-changed",
        wire: Wire::Both,
        mirror: &[1],
        title: ["a port has another number", "端口号变更"],
        text: [
            "Apps connect to the port of their version, so an app cannot connect to a robot of another version.",
            "app 按自己版本里的端口号连接，版本不同的 app 和机器人连不上。",
        ],
    }
    OPERATION_PORT {
        number: 2,
        name: "operation-port-changed",
        wire: Wire::Both,
        mirror: &[2],
        title: ["an operation moved to another port", "接口换了端口"],
        text: [
            "Its frames are sent on one port and expected on the other.",
            "一方在这个端口发送，另一方在另一个端口等待。",
        ],
    }
    HEADER_LAYOUT {
        number: 3,
        name: "header-layout-changed",
        wire: Wire::Both,
        source: &[Rust],
        mirror: &[3],
        title: ["the layout of the header changed", "包头布局变更"],
        text: [
            "A header field was added, removed, moved, resized or got another role. The other version reads all later fields at \
             the wrong place.",
            "包头字段有增删、移位、改长度或改角色，另一个版本会读错其后所有字段的位置。",
        ],
    }
    BYTE_ORDER {
        number: 4,
        name: "byte-order-changed",
        wire: Wire::Both,
        mirror: &[4],
        title: ["the byte order changed", "字节序变更"],
        text: [
            "Every integer of the header is read with its bytes reversed: lengths, codes and ids are wrong.",
            "包头里的整数都按相反的字节序读取，长度、功能码和标识全错。",
        ],
    }
    HEAD_BYTES {
        number: 5,
        name: "head-bytes-changed",
        wire: Wire::Both,
        mirror: &[5],
        title: ["the first bytes of a frame changed", "帧头字节变更"],
        text: [
            "A receiver of the other version does not recognise the start of a frame and closes the connection.",
            "另一个版本的接收方认不出帧头，会断开连接。",
        ],
    }
    KIND_VALUE {
        number: 6,
        name: "kind-value-changed",
        wire: Wire::Both,
        mirror: &[6],
        title: ["a frame kind has another value or is gone", "数据类型的值变更或被删除"],
        text: [
            "The other version does not know the value of this kind, or reads it as another kind. Without a reserved kind, only \
             the name of the error changes.",
            "这类帧的数据类型值，另一个版本不认识，或当成别的类型。删除预留的类型只会改变错误名称。",
        ],
    }
    RESERVED_KIND {
        number: 7,
        name: "reserved-kind-taken",
        wire: Wire::NewSender,
        mirror: &[6],
        title: ["a reserved kind is in use", "预留的数据类型已启用"],
        text: [
            "Receivers of the old version refuse this kind as reserved.",
            "旧版本的接收方会按预留类型拒绝这类帧。",
        ],
    }
    ENCODING_REMOVED {
        number: 8,
        name: "encoding-removed",
        wire: Wire::OldSender,
        mirror: &[9],
        title: ["an encoding is gone", "删除了一种压缩方式"],
        text: [
            "Old senders may still use this encoding, and new receivers refuse it as unknown. A changed value counts as a removal \
             and an addition.",
            "旧发送方仍可能这样压缩，新接收方会因压缩方式未知而拒绝。改了值，按删除一种、新增一种处理。",
        ],
    }
    ENCODING_ADDED {
        number: 9,
        name: "encoding-added",
        wire: Wire::NewSender,
        behaviour: true,
        mirror: &[8],
        title: ["an encoding is new", "新增了一种压缩方式"],
        text: [
            "New senders must not use it before every receiver knows it.",
            "在所有接收方都支持之前，新发送方不能使用。",
        ],
    }
    DIGEST {
        number: 10,
        name: "digest-rule-changed",
        wire: Wire::Both,
        mirror: &[10],
        title: ["the digest is computed differently", "校验算法变更"],
        text: [
            "Each side computes another digest than it receives, and refuses the frame.",
            "双方算出的校验值不一致，帧被拒绝。",
        ],
    }
    LIMIT_LOWERED {
        number: 11,
        name: "limit-lowered",
        wire: Wire::OldSender,
        mirror: &[12],
        title: ["a limit of frames or bodies is lower", "帧或消息体的上限降低"],
        text: [
            "An old sender may send a frame or body that is too large for a new receiver.",
            "旧发送方按旧上限发送的内容，超出新接收方的上限。",
        ],
    }
    LIMIT_RAISED {
        number: 12,
        name: "limit-raised",
        wire: Wire::NewSender,
        mirror: &[11],
        title: ["a limit of frames or bodies is higher", "帧或消息体的上限提高"],
        text: [
            "A new sender may send a frame or body that is too large for an old receiver.",
            "新发送方按新上限发送的内容，超出旧接收方的上限。",
        ],
    }
}
