// The runtime's schema of a message: one constant per type. The compiler checks it against the type.

import type { Constraints } from './constraint.ts'

/** An integer type. */
export type IntegerName = 'i8' | 'i16' | 'i32' | 'u8' | 'u16' | 'u32' | 'i64' | 'u64'

/** A type without parts. */
export type ScalarName = IntegerName | 'bool' | 'f32' | 'f64' | 'string' | 'base64' | 'json'

/** A JSON value as text: numbers keep every digit, and repeated keys are kept. */
export type JsonText = string

/** A key that the spec does not declare, with its value as received. */
export interface ExtraKey {
  /** The key. */
  key: string
  /** Its value. */
  json: JsonText
}

/** Undeclared keys in their order: kept when a message is read, and sent again. */
export type Extra = readonly ExtraKey[]

/** A type with a name. It is a function, since types may be recursive. */
export type NamedSchema = () => AnyStruct | AnyEnum | AnyChoice

/** A struct of any type. */
export interface AnyStruct {
  /** Always this word. */
  readonly is: 'struct'
  /** Its name. */
  readonly name: string
  /** Its fields. */
  readonly fields: Readonly<Record<string, FieldSchema>>
}

/** A value of an enum. */
export type EnumValueOf = number | bigint | string

/** An enum of any type. */
export interface AnyEnum {
  /** Always this word. */
  readonly is: 'enum'
  /** Its name. */
  readonly name: string
  /** Type of its values in JSON. */
  readonly repr: IntegerName | 'string'
  /** Other values are refused. */
  readonly closed?: boolean
  /** The known values. */
  readonly values: Readonly<Record<string, EnumValueOf>>
  /** The spec's facts about its values as states. */
  readonly process?: ProcessSchema<EnumValueOf>
}

/** A choice of any type. */
export interface AnyChoice {
  /** Always this word. */
  readonly is: 'choice'
  /** Its name. */
  readonly name: string
  /** Its forms. */
  readonly forms: Readonly<Record<string, () => AnyStruct>>
}

/** The type of a list. */
export interface ListSchema<Item = TypeSchema> {
  /** The type of its items. */
  readonly list: Item
}

/** The type of a field. */
export type TypeSchema = ScalarName | NamedSchema | ListSchema

/** A value that a condition compares. */
export type Comparable = number | bigint | string | boolean

/** Values of neighbouring fields under which a field is present. Each of those fields must have one of its values. */
export type ConditionSchema = Readonly<Record<string, readonly Comparable[]>>

/** A field of a message. */
export interface FieldSchema extends Constraints {
  /** Its key on the wire. */
  readonly key: string
  /** Its type. */
  readonly type: TypeSchema
  /** It may be absent or null. */
  readonly optional?: boolean
  /** For a 64-bit integer whose range fits a `number`: it is not a `bigint`. */
  readonly safe?: boolean
  /** Other keys under which it is accepted. */
  readonly also?: readonly string[]
  /** A number or bool inside a JSON string, or a bool as 1 or 0. */
  readonly form?: 'string' | 'number'
  /** An empty value counts as absent. */
  readonly emptyIsAbsent?: boolean
  /** A number is also accepted as a string, and in hex. */
  readonly lenientNumber?: boolean
  /** A bool is also accepted as 0 or 1 and as a string. */
  readonly lenientBool?: boolean
  /** The field is present exactly when this condition holds. */
  readonly when?: ConditionSchema
  /** The field is present exactly when this condition does not hold. */
  readonly unless?: ConditionSchema
  /** Value that the receiver takes for an absent field. */
  readonly default?: Comparable
  /** Hidden in texts for people. */
  readonly sensitive?: boolean
}

/** A value of a choice, with the name of its form. */
export interface Tagged<Name extends string = string, Value = unknown> {
  /** Name of the form. */
  case: Name
  /** The value. */
  value: Value
}

/** Maps a TypeScript type to its type in a schema. */
type TypeOf<T> = [T] extends [Uint8Array]
  ? 'base64'
  : [T] extends [readonly (infer Item)[]]
    ? ListSchema<TypeOf<Item>>
    : [T] extends [boolean]
      ? 'bool'
      : [T] extends [bigint]
        ? 'i64' | 'u64' | (() => Enum<T>)
        : [T] extends [number]
          ? IntegerName | 'f32' | 'f64' | (() => Enum<T>)
          : [T] extends [string]
            ? 'string' | 'json' | (() => Enum<T>)
            : () => NamedOf<T>

/** The schema of an object. */
type NamedOf<T> = [T] extends [Tagged] ? Choice<T> : Struct<T>

/** A field's schema without its type and presence. */
type Details = Omit<FieldSchema, 'type' | 'optional'>

/** The schema of a required field. */
interface Required<T> extends Details {
  /** Its type. */
  readonly type: TypeOf<T>
  /** It must be present. */
  readonly optional?: never
}

/** The schema of an optional field. */
interface Optional<T> extends Details {
  /** Its type. */
  readonly type: TypeOf<T>
  /** It may be absent or null. */
  readonly optional: true
}

/** The schema of a field of this type. */
type FieldOf<T> = undefined extends T ? Optional<Exclude<T, undefined>> : Required<T>

/** The schemas of a message's fields; extra keys have none. */
type Fields<T> = { readonly [Name in Exclude<keyof T, 'extra'>]-?: FieldOf<T[Name]> }

/** A message or a part of one: an object with known keys, in the order in which they are sent. */
export interface Struct<T> {
  /** Always this word. */
  readonly is: 'struct'
  /** Its name. */
  readonly name: string
  /** Its fields, by their names in code. */
  readonly fields: Fields<T>
}

/** Rules for an enum's values as states of a process. */
export interface ProcessSchema<T> {
  /**
   * `complete` if `next` names all values that may follow, `normal` if only the usual ones; absent where the spec does
   * not specify it.
   */
  readonly order?: 'complete' | 'normal'
  /** For each value, the values that may follow. */
  readonly next?: readonly (readonly [T, readonly T[]])[]
  /** Final values. */
  readonly final?: readonly T[]
  /** Values that mean a failure. */
  readonly error?: readonly T[]
}

/** An enum. */
export interface Enum<T> {
  /** Always this word. */
  readonly is: 'enum'
  /** Its name. */
  readonly name: string
  /** Type of its values in JSON. */
  readonly repr: IntegerName | 'string'
  /** Other values are refused. */
  readonly closed?: boolean
  /** The known values, by their names. */
  readonly values: Readonly<Record<string, T>>
  /** The spec's facts about its values as states. */
  readonly process?: ProcessSchema<T>
}

/** The names of the forms of a choice. */
type NameOf<T> = T extends Tagged<infer Name> ? Name : never

/** The value of a choice's form. */
type HeldBy<T, Name> = T extends Tagged<Name & string, infer Value> ? Value : never

/** The structs of the forms of a choice. */
type Forms<T> = {
  /** Struct of each form. */
  readonly [Name in NameOf<T>]: () => Struct<HeldBy<T, Name>>
}

/** A choice: the first form whose required keys are all present applies. */
export interface Choice<T> {
  /** Always this word. */
  readonly is: 'choice'
  /** Its name. */
  readonly name: string
  /** Its forms, by their names. */
  readonly forms: Forms<T>
}

/** The message that a schema describes. */
export type MessageOf<S> = S extends Struct<infer T> ? T : never
