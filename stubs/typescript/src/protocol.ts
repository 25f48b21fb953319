// A protocol with its texts, for tools that show any frame. The schemas of the typed stubs read the bodies.

import type { AnyStruct } from './schema.ts'
import type { EnvelopesOf, FrameLayout, Limits, WireEncoding, WireField, WireKind } from './wire.ts'

/** A text in both languages. */
export interface Text {
  /** Chinese. */
  readonly zh: string
  /** English. */
  readonly en: string
}

/** Role of a header field. */
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

/** Digest algorithm of a frame's data. */
export type DigestAlgorithm = 'md5' | 'crc32'

/** A field of the frame's header. */
export interface HeaderField extends WireField, Text {
  /** Name in the source document. */
  readonly wire: string
  /** Name in code. */
  readonly name: string
}

/** A kind of frame. */
export interface Kind extends WireKind, Text {
  /** Its name in code. */
  readonly name: string
  /** The TCP port for such frames. */
  readonly port: number
}

/** Encoding of a frame's data. */
export interface Encoding extends WireEncoding, Text {
  /** Its name in code. */
  readonly name: string
}

/** One of the two messages of an operation. */
export type Side = 'request' | 'response'

/** A command, a report or a stream. */
export interface Operation extends Text {
  /** Its name in the spec. */
  readonly name: string
  /** The kind of operation. */
  readonly kind: 'command' | 'report' | 'stream'
  /** Command code; `null` while none is assigned. */
  readonly code: number | null
  /** The schema of the request, or of a stream's frames; `null` for raw bytes. */
  readonly request: AnyStruct | null
  /** The schema of the response; `null` for a stream. */
  readonly response: AnyStruct | null
  /** The request as JSON, with envelope; for a stream without. Empty for raw bytes. */
  readonly requestExample: string
  /** The response as JSON, with envelope; empty for a stream. */
  readonly responseExample: string
}

/** A result code of responses. */
export interface Result extends Text {
  /** Its number. */
  readonly code: number
  /** Its name in code. */
  readonly name: string
  /** The runtime's use of it; `null` for none. */
  readonly role: string | null
}

/** Command codes with a common use. */
export interface CodeRange extends Text {
  /** The first code. */
  readonly first: number
  /** The last code. */
  readonly last: number
  /** Their common use. */
  readonly use: string
}

/** A protocol. */
export interface Protocol extends FrameLayout {
  /** Its name. */
  readonly title: Text
  /** Fields of the header, in order. */
  readonly header: readonly HeaderField[]
  /** Kinds of frames. */
  readonly kinds: readonly Kind[]
  /** Encodings of the data; none if the header has no field for them. */
  readonly encodings: readonly Encoding[]
  /** The envelope's keys and their roles. */
  readonly envelope: EnvelopesOf
  /** Limits of the data from a peer. */
  readonly limits: Limits
  /** Result codes. */
  readonly results: readonly Result[]
  /** Uses of command codes. */
  readonly ranges: readonly CodeRange[]
  /** Commands, reports and streams. */
  readonly operations: readonly Operation[]
}
