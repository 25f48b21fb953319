// Values that a receiver takes for absent fields.

/** The default values of these fields of a message. */
export type DefaultsOf<Message, Name extends keyof Message> = {
  /** Default of each field. */
  readonly [Key in Name]-?: Exclude<Message[Key], undefined>
}

/** Returns a copy of the message with defaults in place of absent fields. The message does not change. */
export function withDefaults<Message extends object, Filled extends object>(
  message: Message,
  defaults: Filled,
): Omit<Message, keyof Filled> & Filled {
  const present = Object.entries(message).filter(([, value]) => value !== undefined)
  return { ...defaults, ...Object.fromEntries(present) } as Omit<Message, keyof Filled> & Filled
}
