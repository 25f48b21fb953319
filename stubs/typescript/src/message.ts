// Encodes a message of an operation as a frame.

import type { Codec } from './algorithms.ts'
import { BodyError } from './fault.ts'
import { encodeFrame } from './frame.ts'
import { kindOf } from './lookup.ts'
import type { Operation, Side } from './protocol.ts'
import { judge } from './read.ts'
import { utf8Of } from './room.ts'
import { ANY } from './scanner.ts'

/** The parts of a message's frame other than its body. */
export interface MessageParts {
  /** The request or the response. */
  side: Side
  /** Message id. */
  id: number
  /** Compresses the body. */
  gzip: boolean
}

/** Returns the frame of a message; `null` for an operation without a code. Text that is not JSON is sent unchanged. */
export function messageFrame(
  codec: Codec,
  operation: Operation,
  { side, id, gzip }: MessageParts,
  json: string,
): Uint8Array | null {
  const kind = kindOf(codec.protocol, operation)
  if (operation.code === null || !kind) return null
  return encodeFrame(codec, {
    response: side === 'response',
    kind: kind.value,
    code: operation.code,
    id,
    gzip,
    // Indentation is only for people.
    data: new TextEncoder().encode(compact(json, codec.protocol.limits.jsonDepth)),
  })
}

const WHITE = ' \t\n\r'

/** Removes white space outside strings. Numbers keep their spelling, and text that is not JSON is returned unchanged. */
export function compact(text: string, maxDepth: number): string {
  try {
    judge(utf8Of(text), { ...ANY, depth: maxDepth })
  } catch (problem) {
    if (!(problem instanceof BodyError)) throw problem
    return text
  }
  // A regular expression for strings with escapes overflows the stack if there are millions of them.
  let bare = ''
  let from = 0
  let quoted = false
  for (let at = 0; at < text.length; at++) {
    const character = text.charAt(at)
    if (character === '"') quoted = !quoted
    else if (quoted && character === '\\') at++
    else if (!quoted && WHITE.includes(character)) {
      bare += text.slice(from, at)
      from = at + 1
    }
  }
  return bare + text.slice(from)
}
