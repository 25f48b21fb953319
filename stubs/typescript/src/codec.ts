// Frames and bodies of any operation, for tools that show messages. They read bodies by the schemas of the typed messages.

export type { Algorithms, Codec, GunzipFault } from './algorithms.ts'
export { readBody } from './body.ts'
export type { BodyFault, BodyReport, UnknownPlace } from './body.ts'
export { hex, hexByte, hexNumber, readUint, writeUint } from './bytes.ts'
export { errorText } from './errors.ts'
export type { ErrorName } from './errors.ts'
export { decodeFrame, encodeFrame, headerValue, sideOf } from './frame.ts'
export type { Decoded, FieldValue, FrameParts, Verdict } from './frame.ts'
export { hasLoneSurrogate, integral } from './json.ts'
export { fieldOf, kindOf, operationOf } from './lookup.ts'
export { compact, messageFrame } from './message.ts'
export type { MessageParts } from './message.ts'
export type {
  CodeRange,
  DigestAlgorithm,
  Encoding,
  HeaderField,
  HeaderRole,
  Kind,
  Operation,
  Protocol,
  Result,
  Side,
  Text,
} from './protocol.ts'
export type { Limits } from './wire.ts'
export { protocol } from '../generated/protocol.ts'
