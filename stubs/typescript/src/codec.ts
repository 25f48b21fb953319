// The codec without types: frames and bodies by a protocol as data, for tools that show what is sent.

export type { Algorithms, Codec, GunzipFault } from './algorithms.ts'
export { readBody } from './body.ts'
export type { BodyFault, BodyReport, UnknownPlace } from './body.ts'
export { hex, hexByte, hexNumber, readUint, writeUint } from './bytes.ts'
export { errorText } from './errors.ts'
export type { ErrorName } from './errors.ts'
export { decodeFrame, encodeFrame, headerValue, sideOf } from './frame.ts'
export type { Decoded, FieldValue, FrameParts, Verdict } from './frame.ts'
export { JsonFault, compact, hasLoneSurrogate, integral, parseJson } from './json.ts'
export type {
  Json,
  JsonArray,
  JsonBool,
  JsonEntry,
  JsonFaultName,
  JsonNull,
  JsonNumber,
  JsonObject,
  JsonString,
} from './json.ts'
export { fieldOf, kindOf, operationOf } from './lookup.ts'
export { messageFrame } from './message.ts'
export type { MessageParts } from './message.ts'
export type {
  ArrayType,
  CodeRange,
  DigestAlgorithm,
  Encoding,
  EnumDef,
  EnumValue,
  Envelope,
  Field,
  HeaderField,
  HeaderRole,
  IntName,
  Kind,
  Limits,
  NamedType,
  OneOfDef,
  Operation,
  Protocol,
  Result,
  ScalarType,
  Side,
  StreamFacts,
  StructDef,
  Text,
  Type,
  TypeDef,
  Variant,
} from './protocol.ts'
export { protocol } from '../generated/protocol.ts'
