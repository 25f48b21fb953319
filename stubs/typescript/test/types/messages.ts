// Messages as in a package: plain types, each with a constant that the compiler checks against it.

import { bytesOf, readMessage, toJson } from 'fc-protocol/runtime'
import type { Choice, Enum, Extra, Struct } from 'fc-protocol/runtime'

/** An open enum: any other number is kept. */
export type Mode = 1 | 2 | (number & {})

/** Its values. */
export const Mode = { Idle: 1, Moving: 2 } as const

/** A part of a message. */
export interface Place {
  x: number
  name?: string | undefined
  extra?: Extra
}

/** A choice between two. */
export type Target = { case: 'Place'; value: Place } | { case: 'Id'; value: Id }

/** One form of it. */
export interface Id {
  id: bigint
  extra?: Extra
}

/** A message. */
export interface Go {
  mode: Mode
  target: Target
  picture?: Uint8Array | undefined
  flags: boolean[]
  via: Place[]
  serial: number
  extra?: Extra
}

const ModeEnum: Enum<Mode> = { is: 'enum', name: 'Mode', repr: 'u8', values: Mode }
const PlaceStruct: Struct<Place> = {
  is: 'struct',
  name: 'Place',
  fields: { x: { key: 'x', type: 'f64' }, name: { key: 'placeName', type: 'string', optional: true } },
}
const IdStruct: Struct<Id> = { is: 'struct', name: 'Id', fields: { id: { key: 'id', type: 'i64', min: 0n } } }
const TargetChoice: Choice<Target> = { is: 'choice', name: 'Target', forms: { Place: () => PlaceStruct, Id: () => IdStruct } }
const GoStruct: Struct<Go> = {
  is: 'struct',
  name: 'Go',
  fields: {
    mode: { key: 'mode', type: () => ModeEnum },
    target: { key: 'target', type: () => TargetChoice },
    picture: { key: 'picture', type: 'base64', optional: true },
    flags: { key: 'flags', type: { list: 'bool' } },
    via: { key: 'via', type: { list: () => PlaceStruct } },
    serial: { key: 'serial', type: 'i64', safe: true, min: 0, max: 9007199254740991 },
  },
}

const sent: Go = { mode: Mode.Moving, target: { case: 'Id', value: { id: 2n ** 60n } }, flags: [true], via: [{ x: 1 }], serial: 7 }
const text = toJson(GoStruct, sent)
const read: Go = readMessage(GoStruct, bytesOf(text), { depth: 8, values: 100 })
const again = toJson(GoStruct, read)
if (text !== again || typeof read.serial !== 'number') throw new Error(`${text} became ${again}`)

// The compiler finds each mismatch with a type.
// @ts-expect-error a field is missing
export const lacksField: Struct<Id> = { is: 'struct', name: 'Id', fields: {} }
// @ts-expect-error a field too many
export const hasOther: Struct<Id> = { is: 'struct', name: 'Id', fields: { id: { key: 'id', type: 'i64' }, other: { key: 'o', type: 'i64' } } }
// @ts-expect-error a text is no number
export const hasText: Struct<Id> = { is: 'struct', name: 'Id', fields: { id: { key: 'id', type: 'string' } } }
// @ts-expect-error it may not be absent
export const mayLack: Struct<Id> = { is: 'struct', name: 'Id', fields: { id: { key: 'id', type: 'i64', optional: true } } }
// @ts-expect-error it may be absent
export const mustHave: Struct<Place> = { is: 'struct', name: 'Place', fields: { x: { key: 'x', type: 'f64' }, name: { key: 'n', type: 'string' } } }
// @ts-expect-error another struct
export const hasAnother: Choice<Target> = { is: 'choice', name: 'Target', forms: { Place: () => IdStruct, Id: () => IdStruct } }
