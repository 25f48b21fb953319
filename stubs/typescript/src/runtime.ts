// The runtime beneath the generated package.

export { bodyText, readEnvelope, readEnveloped, readMessage } from './read.ts'
export type { Enveloped } from './read.ts'
export { bytesOf, writeEnveloped, writeMessage } from './write.ts'
export { BodyError } from './fault.ts'
export type { BodyErrorKind } from './fault.ts'
export type { Allowance } from './scanner.ts'
export { Session } from './session.ts'
export type { AckPolicy, Answer, Arrival, Due, Ended, FrameId, Incoming, SessionConfig } from './session.ts'
export type {
  Choice, Comparable, ConditionSchema, Enum, Extra, ExtraKey, FieldSchema, IntegerName, JsonText, ListSchema, MessageOf, NamedSchema,
  ProcessSchema, ScalarName, Struct, Tagged, TypeSchema,
} from './schema.ts'
export { FrameStream } from './frames.ts'
export type { FatalFault, FromStream, WholeFrame } from './frames.ts'
