// The runtime's description of a protocol below its messages. A package has one constant of it.

import type { AnyCommand, AnyReportOf, AnyStream, ResultText } from './operation.ts'
import type { DigestAlgorithm, HeaderRole } from './protocol.ts'
import type { AnyStruct } from './schema.ts'
import type { AckPolicy } from './session.ts'

/** A field of the frame's header. */
export interface WireField {
  /** Its first byte. */
  readonly offset: number
  /** Its number of bytes. */
  readonly size: number
  /** Raw bytes, or an unsigned integer in the frame's byte order. */
  readonly type: 'bytes' | 'uint'
  /** Role of the field; `null` if it has a fixed value. */
  readonly role: HeaderRole | null
  /** Digest algorithm; `null` for any other field. */
  readonly algorithm: DigestAlgorithm | null
  /** Value sent for a field without a role. */
  readonly value: number
  /** For the uncompressed length: a received 0 on an uncompressed frame is accepted. */
  readonly zeroWhenPlain: boolean
}

/** A kind of frame. */
export interface WireKind {
  /** Its number in the header. */
  readonly value: number
  /** Content of such frames. Reserved ones are refused. */
  readonly role: 'stream' | 'command' | 'report' | 'reserved'
}

/** An encoding of a frame's data. */
export interface WireEncoding {
  /** Its number in the header. */
  readonly value: number
  /** Plain data, or one gzip member. */
  readonly role: 'plain' | 'gzip'
}

/** Layout of frames. */
export interface FrameLayout {
  /** Byte order of all integers in the header. */
  readonly byteOrder: 'big' | 'little'
  /** Bytes of the header. */
  readonly headerLength: number
  /** Fields of the header, in order. */
  readonly header: readonly WireField[]
  /** First bytes of a request. */
  readonly requestHead: readonly number[]
  /** First bytes of a response. */
  readonly responseHead: readonly number[]
  /** Kinds of frames. */
  readonly kinds: readonly WireKind[]
  /** Encodings of the data; none if the header has no field for them. */
  readonly encodings: readonly WireEncoding[]
}

/** Results that the runtime sends. */
export interface Results {
  /** Success. */
  readonly success: ResultText
  /** Unknown command, reserved kind, wrong digest. */
  readonly protocol: ResultText
  /** No response from the handler in time. */
  readonly timeout: ResultText
  /** A body that does not parse or breaks a constraint. */
  readonly invalid: ResultText
  /** A message older than the configured age. */
  readonly expired: ResultText
}

/** The envelope's keys and their roles. */
export interface EnvelopeOf {
  /** All of them. */
  readonly struct: AnyStruct
  /** The field with the time of the message, in milliseconds. */
  readonly time?: string
}

/** The envelope's keys of a response. */
export interface ResponseEnvelopeOf extends EnvelopeOf {
  /** The field with the result code; absent if every response means success. */
  readonly code?: string
  /** The field with the result's text. */
  readonly text?: string
}

/** The envelope's keys of both sides. */
export interface EnvelopesOf {
  /** Envelope of requests and reports. */
  readonly request: EnvelopeOf
  /** Envelope of responses and acknowledgements. */
  readonly response: ResponseEnvelopeOf
}

/** Limits on everything that grows with the bytes from a peer. */
export interface Limits {
  /** Longest frame, header included, in bytes. */
  readonly frameBytes: number
  /** Longest data after decompression, in bytes. */
  readonly inflatedBytes: number
  /** Most plain bytes per byte of compressed JSON, for more than 1 MiB of plain bytes. */
  readonly inflateRatio: number
  /** Deepest nesting of a JSON body. */
  readonly jsonDepth: number
  /** Most keys of objects and items of lists in a JSON body. */
  readonly jsonValues: number
  /** Calls in flight on one connection. */
  readonly inFlight: number
  /** Reports waiting for one connection. */
  readonly queuedReports: number
  /** Connections at one robot. */
  readonly connections: number
}

/** Times and limits that apply unless the user sets others; times in milliseconds. */
export interface Defaults {
  /** Time a call waits for its response. */
  readonly callTimeout: number
  /** Time a handler may take before the app gets the result for a timeout. */
  readonly handlerTimeout: number
  /** Oldest message that is still served; `null` for any age. */
  readonly maxAge: number | null
  /** Acknowledgement of reports. */
  readonly ack: AckPolicy
  /** Limits. */
  readonly limits: Limits
}

/** A protocol: every number the runtime needs. */
export interface Wire {
  /** Short name, for logs. */
  readonly name: string
  /** Usual address of the robot. */
  readonly host: string
  /** TCP port of commands, responses and reports. */
  readonly commandPort: number
  /** TCP port of streams. */
  readonly dataPort: number
  /** Layout of frames. */
  readonly frame: FrameLayout
  /** Keys of the envelope. */
  readonly envelope: EnvelopesOf
  /** Results that the runtime sends. */
  readonly results: Results
  /** Times and limits that apply unless the user sets others. */
  readonly defaults: Defaults
}

/** A protocol with its operations. */
export interface ProtocolOf {
  /** Its numbers. */
  readonly wire: Wire
  /** Commands. */
  readonly commands: readonly AnyCommand[]
  /** Reports. */
  readonly reports: readonly AnyReportOf[]
  /** Streams. */
  readonly streams: readonly AnyStream[]
}

/** Command codes with a common use that a robot may handle as a whole. */
export interface CodeRangeOf {
  /** The first code. */
  readonly first: number
  /** The last code. */
  readonly last: number
  /** The method of the robot. */
  readonly method: string
}

/** Methods of a robot, with the command that each handles. */
export interface ServiceOf {
  /** The command of each method. */
  readonly methods: Readonly<Record<string, AnyCommand>>
  /** Code ranges that share a method. */
  readonly ranges: readonly CodeRangeOf[]
  /** The method for all other codes. */
  readonly unknown: string
}
