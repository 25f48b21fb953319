// The shape of what the generator knows of a protocol: frames, types and operations as data.

/** A text in both languages. */
export interface Text {
  /** Chinese. */
  zh: string
  /** English. */
  en: string
}

/** What a header field is for. */
export type HeaderRole =
  | 'head'
  | 'kind'
  | 'code'
  | 'id'
  | 'encoding'
  | 'status'
  | 'total_length'
  | 'plain_length'
  | 'digest'

/** How the data of a frame is digested. */
export type DigestAlgorithm = 'md5' | 'crc32'

/** A field of the frame's header. */
export interface HeaderField extends Text {
  /** Name in the source document. */
  wire: string
  /** Name in code. */
  name: string
  /** Its first byte. */
  offset: number
  /** Its number of bytes. */
  size: number
  /** Bytes as they come, or an unsigned integer in the frame's byte order. */
  type: 'bytes' | 'uint'
  /** What it is for, `null` if it has a fixed value. */
  role: HeaderRole | null
  /** How a digest is computed, `null` of any other field. */
  algorithm: DigestAlgorithm | null
  /** Sent where no role decides. */
  value: number
  /** A received 0 on an uncompressed frame is accepted. */
  zeroWhenPlain: boolean
}

/** A kind of frame. */
export interface Kind extends Text {
  /** Its number in the header. */
  value: number
  /** Its name in code. */
  name: string
  /** What such frames carry; reserved ones are refused. */
  role: 'stream' | 'command' | 'report' | 'reserved'
  /** The TCP port for such frames. */
  port: number
}

/** How a frame's data is packed. */
export interface Encoding extends Text {
  /** Its number in the header. */
  value: number
  /** Its name in code. */
  name: string
  /** Whether the data is one gzip member or sent as it is. */
  role: 'plain' | 'gzip'
}

/** The integer types. */
export type IntName = 'i8' | 'i16' | 'i32' | 'i64' | 'u8' | 'u16' | 'u32' | 'u64'

/** A type without items and without a name of its own. */
export interface ScalarType {
  /** Which one. */
  is: 'bool' | 'f32' | 'f64' | 'string' | 'base64' | 'json' | IntName
}

/** A list. */
export interface ArrayType {
  /** Always this word. */
  is: 'array'
  /** Type of its items. */
  of: Type
}

/** A type of `Protocol.types`. */
export interface NamedType {
  /** Always this word. */
  is: 'named'
  /** Its key there. */
  name: string
}

/** Type of a field. */
export type Type = ScalarType | ArrayType | NamedType

/** A key of a message. */
export interface Field extends Text {
  /** As it is written. */
  key: string
  /** Other keys under which it is accepted. */
  also: string[]
  /** Type of its value. */
  type: Type
  /** It may be absent or null. */
  optional: boolean
  /** Unit of a number. */
  unit: string | null
  /** Least value, as exact decimal text. */
  min: string | null
  /** Greatest value, as exact decimal text. */
  max: string | null
  /** Least and greatest number of items, characters or bytes. */
  length: [number, number] | null
  /** Regular expression that all of a string must match. */
  pattern: string | null
  /** A number or bool inside a JSON string. */
  wireString: boolean
  /** An empty value counts as absent. */
  emptyIsAbsent: boolean
  /** A number is also accepted as a string, and in hex. */
  lenientNumber: boolean
  /** A bool is also accepted as 0 or 1 and as a string. */
  lenientBool: boolean
  /** A bool as 1 or 0; few fields have it. */
  wireNumber?: boolean
  /** The values of an enum that it takes, as sent; integers as exact decimal text. Few fields have it. */
  only?: string[]
}

/** An object. */
export interface StructDef extends Text {
  /** Always this word. */
  is: 'struct'
  /** Its keys. */
  fields: Field[]
}

/** A value of an enum. */
export interface EnumValue extends Text {
  /** As text, also for integers. */
  wire: string
  /** Its name in code. */
  name: string
}

/** An enum. */
export interface EnumDef extends Text {
  /** Always this word. */
  is: 'enum'
  /** Type of its values. */
  repr: IntName | 'string'
  /** Other values are refused. */
  closed: boolean
  /** The known values. */
  values: EnumValue[]
}

/** A form of a choice. */
export interface Variant extends Text {
  /** Its name in code. */
  name: string
  /** Its struct, a key of `Protocol.types`. */
  type: string
}

/** A choice: an object of the first form whose required keys are all there. */
export interface OneOfDef extends Text {
  /** Always this word. */
  is: 'one_of'
  /** Its forms. */
  variants: Variant[]
}

/** A type with a name. */
export type TypeDef = StructDef | EnumDef | OneOfDef

/** Which of the two messages of an operation. */
export type Side = 'request' | 'response'

/** A command, a report or a stream. */
export interface Operation extends Text {
  /** Its name in code. */
  name: string
  /** Which of them. */
  kind: 'command' | 'report' | 'stream'
  /** Command code, `null` as long as none is assigned. */
  code: number | null
  /** Name of the request's struct, or of that in a stream's frames; `null` for raw bytes. */
  request: string | null
  /** Name of the response's struct; `null` for a stream. */
  response: string | null
  /** The request as indented JSON, with envelope; that of a stream has none. */
  requestExample: string
  /** The response as indented JSON, with envelope. */
  responseExample: string
  /** What only a stream has; `null` for commands and reports. */
  stream: StreamFacts | null
}

/** What a stream has beside what all operations have. */
export interface StreamFacts {
  /** Which side sends it. */
  from: 'app' | 'robot'
  /** Media type of what its frames carry, `null` where none is stated. */
  content: string | null
  /** Name of the command after which it is sent, `null` where none is stated. */
  startedBy: string | null
  /** Name of the command after which it is no longer sent, `null` where none is stated. */
  stoppedBy: string | null
}

/** Keys beside a message's own, by side. */
export interface Envelope {
  /** Of requests. */
  request: Field[]
  /** Of responses. */
  response: Field[]
}

/** What a peer may not exceed. */
export interface Limits {
  /** Bytes of a frame. */
  frameBytes: number
  /** Bytes of data after decompression. */
  inflatedBytes: number
  /** Levels of nested JSON. */
  jsonDepth: number
}

/** A result code of responses. */
export interface Result extends Text {
  /** Its number. */
  code: number
  /** Its name in code. */
  name: string
  /** What the runtime uses it for. */
  role: string | null
}

/** Command codes with a common use. */
export interface CodeRange extends Text {
  /** The first of them. */
  first: number
  /** The last of them. */
  last: number
  /** What they are for. */
  use: string
}

/** A protocol. */
export interface Protocol {
  /** Its name. */
  title: Text
  /** Of all integers in the header. */
  byteOrder: 'big' | 'little'
  /** Bytes of the header. */
  headerLength: number
  /** Fields of the header, in order. */
  header: HeaderField[]
  /** First bytes of a request. */
  requestHead: number[]
  /** First bytes of a response. */
  responseHead: number[]
  /** Kinds of frames. */
  kinds: Kind[]
  /** Ways to pack the data; none where the header does not say how it is packed. */
  encodings: Encoding[]
  /** Keys beside a message's own. */
  envelope: Envelope
  /** Envelope key of a response's result code; `null` where any response says that all went well. */
  resultCodeKey: string | null
  /** What a peer may not exceed. */
  limits: Limits
  /** Result codes. */
  results: Result[]
  /** Uses of command codes. */
  ranges: CodeRange[]
  /** Types by name. */
  types: Record<string, TypeDef>
  /** Commands, reports and streams. */
  operations: Operation[]
}
