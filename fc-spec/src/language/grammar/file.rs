//! A file of the spec: its top keys.

use super::available::Availability;
use super::common::{Change, Conflict};
use super::coordinates::{CoordinateSystem, Store};
use super::entity::Entity;
use super::field::{Constants, TypeDef};
use super::form::{ConflictId, Entries, Int, List, Name, ResultNumber, Str, TypeName};
use super::glossary::Term;
use super::operation::{Command, Group, Report, Stream};
use super::waiver::Waiver;
use super::wire::{
    Ack, Calls, Codes, Envelope, Frame, Json, Limits, Protocol, ResultCode, Section, Transport,
};

grammar! {
    /// A file of the spec. `protocol.yaml` describes the layers below the messages. Each file in `commands/` holds one group of operations.
    /// 规范的一个文件。`protocol.yaml` 规定消息以下的各层，`commands/*.yaml` 每个文件是一组接口。
    FILE: File = "file" "文件" {
        /// The group of operations in this file.
        /// 这个文件里的接口属于哪个分组。
        optional group: Group;
        /// Commands of the app, by name.
        /// app 的指令，以名称为键。
        optional commands: Entries<Name, Command>,
            faults [MisplacedEntry, DuplicateOperation, DuplicateType, ReservedName];
        /// Reports of the robot, by name.
        /// 机器人的主动上报，以名称为键。
        optional reports: Entries<Name, Report>,
            faults [MisplacedEntry, DuplicateOperation, DuplicateType, ReservedName, AmbiguousState];
        /// Streams, by name.
        /// 数据流，以名称为键。
        optional streams: Entries<Name, Stream>,
            faults [MisplacedEntry, DuplicateOperation, DuplicateType, ReservedName];
        /// Structs, enums and choices, by name.
        /// 结构、枚举和多选一，以名称为键。
        optional types: Entries<TypeName, TypeDef>, faults [MisplacedEntry, DuplicateType, UnusedType, NothingLeft];
        /// Published tables of constants, by id.
        /// 公布的常量表，以 id 为键。
        optional tables: Entries<Name, Constants>, faults [DuplicateTable];
        /// Name and description of the protocol.
        /// 协议的名称和说明。
        optional protocol: Protocol;
        /// Host and ports.
        /// 地址和端口。
        optional transport: Transport;
        /// Layout of a frame.
        /// 帧的结构。
        optional frame: Frame;
        /// Rules for JSON that RFC 8259 leaves open.
        /// RFC 8259 没有规定的 JSON 读法。
        optional json: Json;
        /// Keys of every message, in addition to those of its body.
        /// 消息体的键之外，每条消息都带的键。
        optional envelope: Envelope;
        /// Result codes, by number.
        /// 结果码，以数值为键。
        optional results: Entries<ResultNumber, ResultCode>, faults [RoleMissing];
        /// Waiting times of both sides.
        /// 双方的等待时间。
        optional calls: Calls;
        /// Default resending of reports.
        /// 上报默认的重发。
        optional ack: Ack;
        /// Default limits of client and server.
        /// 客户端和服务端默认的上限。
        optional limits: Limits;
        /// Ranges of codes with a purpose, and codes not to be used again.
        /// 各有用途的号段，以及不得再用的功能码。
        optional codes: Codes;
        /// Numbers of the sections missing from the source document.
        /// 源文档中缺失的各节的节号。
        optional sections: Entries<Int<u16, 1>, Section>, faults [MissingSectionUsed, SectionGap];
        /// Audiences, machines and releases. At most one in a spec.
        /// 受众、机型和版本系列。整个规范最多一份。
        optional availability: Availability;
        /// Dated changes of the protocol as a whole.
        /// 整个协议的历次变更。
        optional changes: List<Change>;
        /// Entities, the things with ids, by name. At most one list in a spec.
        /// 实体，即有 ID 的东西，以名称为键。整个规范最多一份。
        optional entities: Entries<Name, Entity, 1>, faults [UnusedEntity];
        /// Coordinate systems, by name. At most one list in a spec.
        /// 坐标系，以名称为键。整个规范最多一份。
        optional coordinates: Entries<Name, CoordinateSystem, 1>, faults [UnusedCoordinates];
        /// Stores, by name. At most one list in a spec.
        /// 存储位置，以名称为键。整个规范最多一份。
        optional stores: Entries<Name, Store, 1>, faults [UnusedStore];
        /// Terms of the protocol, by id. At most one in a spec.
        /// 术语表，以 id 为键。整个规范最多一份。
        optional glossary: Entries<Name, Term, 1>;
        /// Waivers, by the rule number and fingerprint that `fcproto diff` and `fcproto lint` print. At most one list in a spec.
        /// 豁免，以 `fcproto diff` 和 `fcproto lint` 打印的规则号加指纹为键。整个规范最多一份。
        optional waivers: Entries<Str, Waiver>, faults [BadWaiver];
        /// Gaps and mistakes in the source document that the spec must answer.
        /// 源文档中需要规范答复的缺失和错误。
        optional conflicts: Entries<ConflictId, Conflict>, faults [UnansweredConflict];
    }
}

/// Top keys that a spec has exactly once.
pub(crate) const ONCE: [&str; 12] = [
    FILE.protocol.name,
    FILE.transport.name,
    FILE.frame.name,
    FILE.json.name,
    FILE.envelope.name,
    FILE.results.name,
    FILE.calls.name,
    FILE.ack.name,
    FILE.limits.name,
    FILE.codes.name,
    FILE.sections.name,
    FILE.changes.name,
];

/// Top keys that a spec has at most once.
pub(crate) const AT_MOST_ONCE: [&str; 6] = [
    FILE.entities.name,
    FILE.coordinates.name,
    FILE.stores.name,
    FILE.availability.name,
    FILE.glossary.name,
    FILE.waivers.name,
];

/// Top keys that only files in `commands/` have, together with a `group`.
pub(crate) const GROUPED: [&str; 4] = [
    FILE.group.name,
    FILE.commands.name,
    FILE.reports.name,
    FILE.streams.name,
];
