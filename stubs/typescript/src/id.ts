// Ids of entities, with one type per entity.

declare const entity: unique symbol

/** The id of an entity: its value, with the name of its type. Only the compiler sees the name. */
export type Id<Value extends number | bigint | string, Name extends string> = Value & {
  /** The name of the type. No value has this key. */
  readonly [entity]: Name
}
