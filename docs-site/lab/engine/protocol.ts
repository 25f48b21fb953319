// The shape of `generated/protocol.ts`: what the generator tells the laboratory about the protocol.

export interface Text {
  zh: string
  en: string
}

export type HeaderRole =
  | 'head' | 'kind' | 'code' | 'id' | 'encoding' | 'status' | 'total_length' | 'plain_length' | 'digest'

export interface HeaderField extends Text {
  /** Name in the source document. */
  wire: string
  /** Name in code. */
  name: string
  offset: number
  size: number
  /** Bytes as they come, or an unsigned integer in the frame's byte order. */
  type: 'bytes' | 'uint'
  role: HeaderRole | null
  /** Sent where no role decides. */
  value: number
  /** A received 0 on an uncompressed frame is accepted. */
  zeroWhenPlain: boolean
}

export interface Kind extends Text {
  value: number
  name: string
  role: 'stream' | 'command' | 'report' | 'reserved'
  port: number
}

export interface Encoding extends Text {
  value: number
  name: string
  role: 'plain' | 'gzip'
}

export type IntName = 'i8' | 'i16' | 'i32' | 'i64' | 'u8' | 'u16' | 'u32' | 'u64'

export type Type =
  | { is: 'bool' | 'f32' | 'f64' | 'string' | 'base64' | 'json' | IntName }
  | { is: 'array'; of: Type }
  | { is: 'named'; name: string }

export interface Field extends Text {
  key: string
  also: string[]
  type: Type
  optional: boolean
  unit: string | null
  /** Decimal text, exact. */
  min: string | null
  max: string | null
  length: [number, number] | null
  pattern: string | null
  /** A number or bool inside a JSON string. */
  wireString: boolean
  emptyIsAbsent: boolean
  lenientNumber: boolean
  lenientBool: boolean
}

export type TypeDef = Text &
  (
    | { is: 'struct'; fields: Field[] }
    | { is: 'enum'; repr: IntName | 'string'; closed: boolean; values: (Text & { wire: string; name: string })[] }
    | { is: 'one_of'; variants: (Text & { name: string; type: string })[] }
  )

export interface Operation extends Text {
  name: string
  kind: 'command' | 'report' | 'stream'
  code: number | null
  /** Name of the struct type, `null` for raw bytes. */
  request: string | null
  response: string | null
  /** Indented JSON with envelope. */
  requestExample: string
  responseExample: string
}

export interface Protocol {
  title: Text
  byteOrder: 'big' | 'little'
  headerLength: number
  header: HeaderField[]
  requestHead: number[]
  responseHead: number[]
  kinds: Kind[]
  encodings: Encoding[]
  /** Keys beside a message's own, by side. */
  envelope: { request: Field[]; response: Field[] }
  /** Envelope key of a response's result code. */
  resultCodeKey: string
  limits: { frameBytes: number; inflatedBytes: number; jsonDepth: number }
  results: (Text & { code: number; name: string; role: string | null })[]
  ranges: (Text & { first: number; last: number; use: string })[]
  types: Record<string, TypeDef>
  operations: Operation[]
}

/** Names shared with the Rust engine and the golden vectors. */
export type ErrorName =
  | 'bad_head' | 'short_frame' | 'frame_too_long' | 'unknown_kind' | 'reserved_kind' | 'unknown_encoding'
  | 'bad_digest' | 'bad_gzip' | 'plain_length_mismatch' | 'inflated_too_long' | 'truncated'
  | 'not_utf8' | 'bad_json' | 'not_an_object' | 'wrong_type' | 'missing_field' | 'duplicate_key' | 'lone_surrogate' | 'out_of_range' | 'bad_length'
  | 'bad_pattern' | 'unknown_value' | 'no_variant' | 'too_deep' | 'bad_base64'
