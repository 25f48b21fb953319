// What the runtime has to know of a protocol beneath its messages. A package has one constant of it.

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
  /** Bytes as they come, or an unsigned integer in the frame's byte order. */
  readonly type: 'bytes' | 'uint'
  /** What it is for, `null` if it has a fixed value. */
  readonly role: HeaderRole | null
  /** How a digest is computed, `null` of any other field. */
  readonly algorithm: DigestAlgorithm | null
  /** Sent where no role decides. */
  readonly value: number
  /** Of the plain length: a received 0 on a frame that is not compressed is accepted. */
  readonly zeroWhenPlain: boolean
}

/** A kind of frame. */
export interface WireKind {
  /** Its number in the header. */
  readonly value: number
  /** What such frames carry; reserved ones are refused. */
  readonly role: 'stream' | 'command' | 'report' | 'reserved'
}

/** A way to pack the data of a frame. */
export interface WireEncoding {
  /** Its number in the header. */
  readonly value: number
  /** As it is, or as one gzip member. */
  readonly role: 'plain' | 'gzip'
}

/** How frames are laid out. */
export interface FrameLayout {
  /** Of all integers in the header. */
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
  /** Ways to pack the data; none where the header does not say how it is packed. */
  readonly encodings: readonly WireEncoding[]
}

/** Results the runtime itself answers with. */
export interface Results {
  /** The call did what it should. */
  readonly success: ResultText
  /** Unknown command, reserved kind, wrong digest. */
  readonly protocol: ResultText
  /** No answer from the handler in time. */
  readonly timeout: ResultText
  /** A body that does not parse or breaks a constraint. */
  readonly invalid: ResultText
  /** A message older than the configured age. */
  readonly expired: ResultText
}

/** The keys beside a message's own, and what they are for. */
export interface EnvelopeOf {
  /** All of them. */
  readonly struct: AnyStruct
  /** The field with the time of the message, in milliseconds. */
  readonly time?: string
}

/** The keys beside a response's own. */
export interface ResponseEnvelopeOf extends EnvelopeOf {
  /** The field with the result code; where there is none, any response says that all went well. */
  readonly code?: string
  /** The field with the text beside the code. */
  readonly text?: string
}

/** The keys beside a message's own, of both sides. */
export interface EnvelopesOf {
  /** Of requests and reports. */
  readonly request: EnvelopeOf
  /** Of responses and acknowledgements. */
  readonly response: ResponseEnvelopeOf
}

/** Bounds of everything that grows with what a peer sends. */
export interface Limits {
  /** Longest frame, header included, in bytes. */
  readonly frameBytes: number
  /** Longest data after decompression, in bytes. */
  readonly inflatedBytes: number
  /** Most bytes that one byte of compressed JSON may become, where more than 1 MiB come out. */
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

/** Times and limits where the user sets none; times in milliseconds. */
export interface Defaults {
  /** How long a call waits for its response. */
  readonly callTimeout: number
  /** How long a handler may take before the app is told. */
  readonly handlerTimeout: number
  /** Oldest message that is still served; `null` for any age. */
  readonly maxAge: number | null
  /** Acknowledgement of reports. */
  readonly ack: AckPolicy
  /** Bounds. */
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
  /** How frames are laid out. */
  readonly frame: FrameLayout
  /** Keys beside a message's own. */
  readonly envelope: EnvelopesOf
  /** Results the runtime itself answers with. */
  readonly results: Results
  /** Times and limits where the user sets none. */
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
  /** The first of them. */
  readonly first: number
  /** The last of them. */
  readonly last: number
  /** The method of the robot. */
  readonly method: string
}

/** What a robot's methods are called: which command each handles. */
export interface ServiceOf {
  /** The command of each method. */
  readonly methods: Readonly<Record<string, AnyCommand>>
  /** Codes that have no method of their own. */
  readonly ranges: readonly CodeRangeOf[]
  /** The method for all other codes. */
  readonly unknown: string
}
