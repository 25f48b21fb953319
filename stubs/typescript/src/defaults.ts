// What a receiver takes for fields that are absent.

/** What the absence of these fields of a message means. */
export type DefaultsOf<Message, Name extends keyof Message> = {
  /** That of each. */
  readonly [Key in Name]: Exclude<Message[Key], undefined>
}

/** A message with what the absence of its fields means in their place; the message itself stays as it is. */
export function withDefaults<Message extends object, Filled extends object>(
  message: Message,
  defaults: Filled,
): Omit<Message, keyof Filled> & Filled {
  const present = Object.entries(message).filter(([, value]) => value !== undefined)
  return { ...defaults, ...Object.fromEntries(present) } as Omit<Message, keyof Filled> & Filled
}
