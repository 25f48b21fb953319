//! Frame and transport.

use super::{BASE, rules};
use crate::rule::Language::Rust;
use crate::rule::{Rule, Wire};

rules! {
    FC0701 PORT_NUMBER "port-number-changed" "端口号变更" "a port has another number" {
        wire: Wire::Both, mirror: &[1],
    }
    FC0702 OPERATION_PORT "operation-port-changed" "接口换了端口" "an operation moved to another port" {
        wire: Wire::Both, mirror: &[2],
    }
    FC0703 HEADER_LAYOUT "header-layout-changed" "包头布局变更" "the layout of the header changed" {
        wire: Wire::Both, source: &[Rust], mirror: &[3],
    }
    FC0704 BYTE_ORDER "byte-order-changed" "字节序变更" "the byte order changed" {
        wire: Wire::Both, mirror: &[4],
    }
    FC0705 HEAD_BYTES "head-bytes-changed" "帧头字节变更" "the first bytes of a frame changed" {
        wire: Wire::Both, mirror: &[5],
    }
    FC0706 KIND_VALUE "kind-value-changed" "数据类型的值变更或被删除" "a frame kind has another value or is gone" {
        wire: Wire::Both, mirror: &[6],
    }
    FC0707 RESERVED_KIND "reserved-kind-taken" "预留的数据类型已启用" "a reserved kind is in use" {
        wire: Wire::NewSender, mirror: &[6],
    }
    FC0708 ENCODING_REMOVED "encoding-removed" "删除了一种压缩方式" "an encoding is gone" {
        wire: Wire::OldSender, mirror: &[9],
    }
    FC0709 ENCODING_ADDED "encoding-added" "新增了一种压缩方式" "an encoding is new" {
        wire: Wire::NewSender, behaviour: true, mirror: &[8],
    }
    FC0710 DIGEST "digest-rule-changed" "校验算法变更" "the digest is computed differently" {
        wire: Wire::Both, mirror: &[10],
    }
    FC0711 LIMIT_LOWERED "limit-lowered" "帧或消息体的上限降低" "a limit of frames or bodies is lower" {
        wire: Wire::OldSender, mirror: &[12],
    }
    FC0712 LIMIT_RAISED "limit-raised" "帧或消息体的上限提高" "a limit of frames or bodies is higher" {
        wire: Wire::NewSender, mirror: &[11],
    }
}
