// The runtime of the generated package.

export type { DefaultsOf } from './defaults.ts'
export { withDefaults } from './defaults.ts'
export { isKnown, nameOf } from './enums.ts'
export { bodyText, fromJson, readEnvelope, readEnveloped, readMessage } from './read.ts'
export type { Enveloped } from './read.ts'
export { bytesOf, toJson, writeEnveloped } from './write.ts'
export { BodyError } from './fault.ts'
export type { BodyErrorKind, OwnLimit } from './fault.ts'
export type { ErrorName } from './errors.ts'
export type { Id } from './id.ts'
export type { Allowance } from './scanner.ts'
export { Session } from './session.ts'
export type {
  AckPolicy,
  Answer as SessionAnswer,
  Arrival,
  Due,
  Ended,
  FrameId,
  Incoming,
  SessionConfig,
} from './session.ts'
export type {
  AnyChoice,
  AnyEnum,
  AnyStruct,
  Choice,
  Comparable,
  ConditionSchema,
  Enum,
  EnumValueOf,
  Extra,
  ExtraKey,
  FieldSchema,
  IntegerName,
  JsonText,
  ListSchema,
  MessageOf,
  NamedSchema,
  ProcessSchema,
  ScalarName,
  Struct,
  Tagged,
  TypeSchema,
} from './schema.ts'
export { FrameStream } from './frames.ts'
export type { FatalFault, FromStream } from './frames.ts'
export { Framing } from './framing.ts'
export type { Beginning, FrameLimits, WholeFrame } from './framing.ts'
export { md5 } from './md5.ts'
export { acceptedIn } from './operation.ts'
export type {
  AnyCommand,
  AnyReportOf,
  AnyStream,
  Cadence,
  Command,
  Declares,
  Effect,
  FollowedCommand,
  OperationFacts,
  Preconditions,
  Report,
  Reported,
  ResultText,
  SetOff,
  StateOf,
  States,
  Stream,
  Tie,
} from './operation.ts'
export type {
  CodeRangeOf,
  Defaults,
  EnvelopeOf,
  EnvelopesOf,
  FrameLayout,
  Limits,
  ProtocolOf,
  ResponseEnvelopeOf,
  Results,
  ServiceOf,
  Wire,
  WireEncoding,
  WireField,
  WireKind,
} from './wire.ts'
export type { DigestAlgorithm, HeaderRole, Text } from './protocol.ts'
export { TransportError } from './platform.ts'
export type {
  Clock,
  DialOptions,
  Listener,
  ListenOptions,
  Platform,
  PlatformAlgorithms,
  ServerPlatform,
  Soon,
  Transport,
} from './platform.ts'
export { Refusal } from './refusal.ts'
export { lossText } from './loss.ts'
export type { Loss } from './loss.ts'
export type { Log, LogFields, LogLevel } from './log.ts'
export { CallError, callErrorText, ConnectError, DataError, FollowError } from './client/error.ts'
export type { CallErrorCause, CallErrorKind, DataErrorCause, DataErrorKind, FrameFault } from './client/error.ts'
export { defaultBackoff } from './client/config.ts'
export type { Backoff, CallOptions, ClientConfig, Gzip } from './client/config.ts'
export type { ConnectionState } from './client/life.ts'
export { Connection, Started, dial, dialLater } from './client/connection.ts'
export type { RawResponse, UnknownReport } from './client/connection.ts'
export type { ClientCounters } from './client/counters.ts'
export type { EndedCall } from './ended.ts'
export { Following } from './client/following.ts'
export type { FollowableCall, Followed } from './client/following.ts'
export { Reports } from './client/reports.ts'
export { ConditionError, checked, isError, isFinal, isInOrder, mayFollow, redacted } from './process.ts'
export { DataConnection } from './client/data.ts'
export { Subscription } from './client/subscription.ts'
export type { StreamFrame, StreamItem } from './client/subscription.ts'
export type { AppConnection } from './server/server.ts'
export { Server, robotWithoutPorts, serveRobot } from './server/server.ts'
export { AppStreams } from './server/data_peer.ts'
export type { AppStream } from './server/data_peer.ts'
export { PushError } from './server/types.ts'
export type {
  AckOutcome,
  Acknowledgement,
  Answer,
  Audience,
  ConnectionId,
  Context,
  PushErrorKind,
  RawRequest,
} from './server/types.ts'
export type { Allowed } from './server/allow.ts'
export type { ServerConfig } from './server/config.ts'
export type { ServerCounters } from './server/counters.ts'
export { addAppStreams, addCalls, addExamples, addReports, addRobotStreams } from './stubs.ts'
export type { Stub } from './stubs.ts'
