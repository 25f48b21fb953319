// A captured stream: its frames, the bytes between them, the content of each frame, and the pairs of requests and
// responses.

import {
  decodeFrame, fieldOf, headerValue, operationOf, readBody, sideOf,
  type BodyReport, type Codec, type Decoded, type ErrorName, type Kind, type Operation, type Protocol, type Side,
} from '../fc'
import type { Segment } from './dump'

/** A run of bytes of one stream. */
export interface Piece {
  /** A frame, valid or not; the beginning of one at the end of the stream; bytes that belong to none. */
  is: 'frame' | 'partial' | 'garbage'
  stream: number
  /** First byte, counted in its stream. */
  at: number
  bytes: Uint8Array
  decoded: Decoded
  /** Bytes that a partial frame lacks; a minimum if even its length is missing. */
  missing: { bytes: number; atLeast: boolean } | null
}

/** A piece with its decoded facts. */
export interface Judged extends Piece {
  side: Side | null
  kind: Kind | null
  id: number | null
  operation: Operation | null
  code: number | null
  body: BodyReport | null
  fault: ErrorName | null
  /** Index of the response to this frame, or of its request. */
  partner: number | null
  /** Index of the first frame with the same kind, code and id from the same side. */
  repeats: number | null
}

/** All pasted bytes. */
export interface Capture {
  pieces: Judged[]
  frames: number
  sound: number
  /** Frames with a code that the spec does not declare. */
  unknown: number
  streams: number
  /** Bytes that belong to no frame. */
  skipped: number
  /** Good only if every byte belongs to a valid frame of a known operation. */
  level: 'good' | 'care' | 'bad'
}

/** Splits one stream. */
export function splitStream(codec: Codec, bytes: Uint8Array, stream = 0): Piece[] {
  const { protocol } = codec
  const lengthField = fieldOf(protocol, 'total_length')
  const heads = [protocol.requestHead, protocol.responseHead]
  const headAt = (at: number) => heads.some((head) => head.every((byte, index) => bytes[at + index] === byte))
  const lengthFault = (decoded: Decoded) => decoded.verdicts.find(({ what }) => what === 'length')?.fault ?? null
  const decode = (at: number, end?: number) => decodeFrame(codec, bytes.subarray(at, end))

  /** Returns `true` if a frame may begin here: the head is complete, and the header has no error so far. */
  const plausible = (at: number) => {
    if (!headAt(at)) return false
    // Only the header: a digest over all later bytes would make a long search slow.
    const header = decode(at, at + protocol.headerLength)
    const bad = lengthFault(header)
    if (bad !== null && bad !== 'truncated') return false
    const kind = headerValue(header, 'kind')
    const encoding = headerValue(header, 'encoding')
    return (
      (kind === null || protocol.kinds.some(({ value }) => value === kind)) &&
      (encoding === null || protocol.encodings.some(({ value }) => value === encoding))
    )
  }
  /** Returns `true` if a frame surely begins here: it is valid, or a frame or the end follows it. */
  const certain = (at: number) => {
    if (!plausible(at)) return false
    const decoded = decode(at)
    if (lengthFault(decoded) !== null) return false
    const end = at + protocol.headerLength + decoded.data.length
    return decoded.fault === null || end === bytes.length || headAt(end)
  }
  const find = (from: number, to: number, holds: (at: number) => boolean) => {
    for (let at = from; at < to; at++) if (holds(at)) return at
    return null
  }

  const pieces: Piece[] = []
  let at = 0
  const add = (is: Piece['is'], end: number, missing: Piece['missing'] = null) => {
    pieces.push({ is, stream, at, bytes: bytes.subarray(at, end), decoded: decode(at, end), missing })
    at = end
  }
  while (at < bytes.length) {
    const decoded = decode(at)
    const bad = lengthFault(decoded)
    if (decoded.fault === 'bad_head') add('garbage', find(at + 1, bytes.length, plausible) ?? bytes.length)
    else if (bad === null) {
      const end = at + protocol.headerLength + decoded.data.length
      const trusted = decoded.fault === null || end === bytes.length || headAt(end)
      // A frame that lost bytes extends into the next one.
      add('frame', trusted ? end : (find(at + 1, end, certain) ?? end))
    } else if (bad === 'truncated') {
      const next = find(at + 1, bytes.length, certain)
      const there = bytes.length - at
      const told = there >= lengthField.offset + lengthField.size
      const whole = told ? (headerValue(decoded, 'total_length') ?? 0) : protocol.headerLength
      if (next === null) add('partial', bytes.length, { bytes: whole - there, atLeast: !told })
      else add('frame', next)
    } else add('frame', find(at + 1, bytes.length, plausible) ?? bytes.length)
  }
  return pieces
}

/** Decodes a piece without looking at others. */
function judge(protocol: Protocol, piece: Piece): Judged {
  const { decoded } = piece
  const known = piece.is !== 'garbage'
  const kindValue = headerValue(decoded, 'kind')
  const kind = (known && protocol.kinds.find(({ value }) => value === kindValue)) || null
  const code = known ? headerValue(decoded, 'code') : null
  const side = known ? sideOf(protocol, decoded) : null
  const operation = operationOf(protocol, code, kind)
  const isBytes = kind?.role === 'stream' && !operation?.request
  const body = decoded.plain && side && !isBytes ? readBody(protocol, operation, side, decoded.plain) : null
  const fault = decoded.fault ?? body?.faults[0]?.name ?? null
  return { ...piece, side, kind, id: known ? headerValue(decoded, 'id') : null, operation, code, body, fault, partner: null, repeats: null }
}

/** Pairs responses with requests by kind, code and id: with the nearest request before, or else with one after. */
function pair(pieces: Judged[]): void {
  const key = ({ kind, code, id }: Judged) => (kind === null || code === null || id === null ? null : `${kind.value} ${code} ${id}`)
  const open = new Map<string, number[]>()
  const first = new Map<string, number>()
  pieces.forEach((piece, index) => {
    const name = key(piece)
    if (name === null || piece.side === null) return
    const before = first.get(`${piece.side} ${name}`)
    if (before === undefined) first.set(`${piece.side} ${name}`, index)
    else piece.repeats = before
    const other = piece.side === 'request' ? 'response' : 'request'
    const partner = open.get(`${other} ${name}`)?.pop()
    if (partner === undefined) {
      const waiting = open.get(`${piece.side} ${name}`)
      if (waiting) waiting.push(index)
      else open.set(`${piece.side} ${name}`, [index])
      return
    }
    piece.partner = partner
    pieces[partner].partner = index
  })
}

/** Splits and decodes the pasted bytes. */
export function readCapture(codec: Codec, segments: Segment[]): Capture {
  const streams = [...new Set(segments.map(({ stream }) => stream))]
  const placed: { piece: Piece; order: number }[] = []
  for (const stream of streams) {
    const own: { from: number; order: number; bytes: Uint8Array }[] = []
    let order = 0
    let length = 0
    for (const segment of segments) {
      if (segment.stream === stream) {
        own.push({ from: length, order, bytes: segment.bytes })
        length += segment.bytes.length
      }
      order += segment.bytes.length
    }
    const bytes = new Uint8Array(length)
    for (const part of own) bytes.set(part.bytes, part.from)
    for (const piece of splitStream(codec, bytes, stream)) {
      const part = own.findLast(({ from }) => from <= piece.at)
      placed.push({ piece, order: (part?.order ?? 0) + piece.at - (part?.from ?? 0) })
    }
  }
  const pieces = placed.sort((a, b) => a.order - b.order).map(({ piece }) => judge(codec.protocol, piece))
  pair(pieces)
  const frames = pieces.filter(({ is }) => is === 'frame')
  const unknown = frames.filter(({ operation, kind }) => operation === null && kind?.role !== 'stream').length
  const bad = pieces.some(({ fault }) => fault !== null)
  return {
    pieces,
    frames: frames.length,
    sound: frames.filter(({ fault }) => fault === null).length,
    unknown,
    streams: streams.length,
    skipped: pieces.filter(({ is }) => is === 'garbage').reduce((sum, { bytes }) => sum + bytes.length, 0),
    level: bad ? 'bad' : unknown > 0 ? 'care' : 'good',
  }
}
