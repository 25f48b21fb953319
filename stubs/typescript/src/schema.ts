// What the runtime has to know of a message: one constant for each type, which the compiler holds to the type itself.

import type { Constraints } from './constraint.ts'

/** An integer type. */
export type IntegerName = 'i8' | 'i16' | 'i32' | 'u8' | 'u16' | 'u32' | 'i64' | 'u64'

/** A type without parts. */
export type ScalarName = IntegerName | 'bool' | 'f32' | 'f64' | 'string' | 'base64' | 'json'

/** A JSON value as its text, so that numbers keep every digit and repeated keys stay what they are. */
export type JsonText = string

/** A key that the spec does not know, with its value as it was written. */
export interface ExtraKey {
  /** The key. */
  key: string
  /** Its value. */
  json: JsonText
}

/** Keys that the spec does not know, in their order: kept when a message is read, and sent again. */
export type Extra = readonly ExtraKey[]

/** A type with a name. Behind a function, since types may hold one another. */
export type NamedSchema = () => AnyStruct | AnyEnum | AnyChoice

/** A struct, where its type does not matter. */
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

/** An enum, where its type does not matter. */
export interface AnyEnum {
  /** Always this word. */
  readonly is: 'enum'
  /** Its name. */
  readonly name: string
  /** What its values are on the wire. */
  readonly repr: IntegerName | 'string'
  /** Other values are refused. */
  readonly closed?: boolean
  /** The known values. */
  readonly values: Readonly<Record<string, EnumValueOf>>
  /** What the spec says of its values as states. */
  readonly process?: ProcessSchema<EnumValueOf>
}

/** A choice, where its type does not matter. */
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

/** Under which values of the fields beside it a field is there. All of the fields must have one of their values. */
export type ConditionSchema = Readonly<Record<string, readonly Comparable[]>>

/** A field of a message. */
export interface FieldSchema extends Constraints {
  /** Its key on the wire. */
  readonly key: string
  /** Its type. */
  readonly type: TypeSchema
  /** It may be absent or null. */
  readonly optional?: boolean
  /** Of a 64-bit integer: its range fits a `number`, which is why it is not a `bigint`. */
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
  /** It is there exactly where this holds. */
  readonly when?: ConditionSchema
  /** It is there exactly where this does not hold. */
  readonly unless?: ConditionSchema
  /** What the receiver takes for an absent field. */
  readonly default?: Comparable
  /** Kept out of texts for people. */
  readonly sensitive?: boolean
}

/** A value of a choice: the name of its form, and what this one holds. */
export interface Tagged<Name extends string = string, Value = unknown> {
  /** Which form. */
  case: Name
  /** What it holds. */
  value: Value
}

/** What a type of TypeScript is in a schema. */
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

/** What the schema of a field says beside its type and its presence. */
type Details = Omit<FieldSchema, 'type' | 'optional'>

/** The schema of a field that is always there. */
interface Required<T> extends Details {
  /** Its type. */
  readonly type: TypeOf<T>
  /** It may not be absent. */
  readonly optional?: never
}

/** The schema of a field that may be absent. */
interface Optional<T> extends Details {
  /** Its type. */
  readonly type: TypeOf<T>
  /** It may be absent or null. */
  readonly optional: true
}

/** The schema of a field of this type. */
type FieldOf<T> = undefined extends T ? Optional<Exclude<T, undefined>> : Required<T>

/** The schemas of the fields of a message; unknown keys have none. */
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

/** How the values of an enum follow one another as states of a process. */
export interface ProcessSchema<T> {
  /** Whether `next` names all that may follow, or only what usually does; absent where the spec says nothing of that. */
  readonly order?: 'complete' | 'normal'
  /** Which values follow a value. */
  readonly next?: readonly (readonly [T, readonly T[]])[]
  /** Those that nothing follows. */
  readonly final?: readonly T[]
  /** Those that say that something failed. */
  readonly error?: readonly T[]
}

/** An enum. */
export interface Enum<T> {
  /** Always this word. */
  readonly is: 'enum'
  /** Its name. */
  readonly name: string
  /** What its values are on the wire. */
  readonly repr: IntegerName | 'string'
  /** Other values are refused. */
  readonly closed?: boolean
  /** The known values, by their names. */
  readonly values: Readonly<Record<string, T>>
  /** What the spec says of its values as states. */
  readonly process?: ProcessSchema<T>
}

/** The names of the forms of a choice. */
type NameOf<T> = T extends Tagged<infer Name> ? Name : never

/** What a form of a choice holds. */
type HeldBy<T, Name> = T extends Tagged<Name & string, infer Value> ? Value : never

/** The structs of the forms of a choice. */
type Forms<T> = {
  /** That of each form. */
  readonly [Name in NameOf<T>]: () => Struct<HeldBy<T, Name>>
}

/** A choice: an object of the first form whose required keys are all there. */
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
