//! The words of fields and their values.

use super::{Meaning, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

words! {
    /// Meaning of the `then` lists of an enum's values.
    pub enum StateOrder {
        /// The normal order of the values. Other changes may occur as well.
        /// 取值的正常顺序；也可能出现其他切换。
        Normal = "normal",
        /// All changes: no other change occurs.
        /// 全部的切换：不会出现其他切换。
        Complete = "complete",
    }
}

words! {
    /// Integers, named as in Rust.
    pub enum IntKind {
        /// 8 bits, signed.
        /// 8 位，有符号。
        I8 = "i8",
        /// 16 bits, signed.
        /// 16 位，有符号。
        I16 = "i16",
        /// 32 bits, signed.
        /// 32 位，有符号。
        I32 = "i32",
        /// 64 bits, signed.
        /// 64 位，有符号。
        I64 = "i64",
        /// 8 bits, unsigned.
        /// 8 位，无符号。
        U8 = "u8",
        /// 16 bits, unsigned.
        /// 16 位，无符号。
        U16 = "u16",
        /// 32 bits, unsigned.
        /// 32 位，无符号。
        U32 = "u32",
        /// 64 bits, unsigned.
        /// 64 位，无符号。
        U64 = "u64",
    }
}

impl IntKind {
    /// Returns the smallest and the largest value.
    #[must_use]
    pub fn range(self) -> (i128, i128) {
        match self {
            Self::I8 => (i8::MIN.into(), i8::MAX.into()),
            Self::I16 => (i16::MIN.into(), i16::MAX.into()),
            Self::I32 => (i32::MIN.into(), i32::MAX.into()),
            Self::I64 => (i64::MIN.into(), i64::MAX.into()),
            Self::U8 => (0, u8::MAX.into()),
            Self::U16 => (0, u16::MAX.into()),
            Self::U32 => (0, u32::MAX.into()),
            Self::U64 => (0, u64::MAX.into()),
        }
    }
}

words! {
    /// Floating-point numbers, named as in Rust.
    pub enum FloatKind {
        /// 32 bits (IEEE 754).
        /// 32 位（IEEE 754）。
        F32 = "f32",
        /// 64 bits (IEEE 754).
        /// 64 位（IEEE 754）。
        F64 = "f64",
    }
}

words! {
    /// Form in which a value is sent. A spec gives it only if it differs from the type.
    pub enum WireForm {
        /// According to its type.
        /// 与类型一致。
        Plain = "plain",
        /// A number or bool inside a JSON string.
        /// 数值或布尔值写在 JSON 字符串里。
        String = "string",
        /// A bool as a number: 1 is true, 0 is false. 1.0 and 1e0 are also read as 1; any other number is refused.
        /// 布尔值写成数字：1 表示 true，0 表示 false。接收时，1.0 和 1e0 也算 1；其他数字一律拒绝。
        Number = "number",
    }
}

words! {
    /// Leniency of a decoder. The encoder always sends the canonical form.
    pub enum Quirk {
        /// null, {}, [] and "" are read as an absent optional field.
        /// null、{}、[] 和 "" 都当作没有这个可选字段。
        EmptyIsAbsent = "empty_is_absent",
        /// A number is also read from a string, decimal or 0x.
        /// 数值也可以写成字符串，十进制或 0x。
        LenientNumber = "lenient_number",
        /// A bool is also read from "true"/"false" and 0/1.
        /// 布尔值也可以写成 "true"/"false" 和 0/1。
        LenientBool = "lenient_bool",
    }
}
