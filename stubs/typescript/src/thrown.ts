// Errors of user code as log fields: only class and place. The message may quote a body.

/** The log fields of an error. */
export interface ThrownFields {
  /** Class of the error, or the type of a thrown value that is not an error. */
  readonly error: string
  /** Innermost line of user code, as file, line and column; absent if the stack does not have it. */
  readonly at?: string
  /** The index signature of a `LogFields`. */
  readonly [field: string]: string
}

/** A frame of a stack trace of V8, with its place. */
const FRAME = /^\s*at (?:async )?(?:.* \()?(.+:\d+:\d+)\)?$/

/** The places of a stack trace, innermost first. They follow the message, which may have lines that look like places. */
function placesOf({ stack, message }: Error): string[] {
  // A program may replace the stacks with another type.
  const start = typeof stack === 'string' ? stack.indexOf(message) : -1
  if (stack === undefined || start < 0) return []
  const lines = stack.slice(start + message.length).split('\n')
  return lines.flatMap((line) => FRAME.exec(line)?.[1] ?? [])
}

const folderOf = (place: string): string => place.replace(/[^/\\]*$/, '')

/** The folder of this file, spelled as stack traces spell it. */
const RUNTIME = folderOf(placesOf(new Error('here'))[0] ?? '')

/** The innermost place of user code: not of the platform, of a library or of the runtime. */
function ownPlace(places: readonly string[]): string | undefined {
  const inFiles = places.filter((place) => !place.startsWith('node:'))
  const isOwn = (place: string): boolean =>
    !/[/\\]node_modules[/\\]/.test(place) && !(RUNTIME !== '' && place.startsWith(RUNTIME))
  // In a bundle, user code and runtime share a file.
  return inFiles.find(isOwn) ?? inFiles[0]
}

/** Describes a thrown value for the log. */
export function thrownFields(problem: unknown): ThrownFields {
  try {
    if (!(problem instanceof Error)) return { error: problem === null ? 'null' : typeof problem }
    const error = problem.constructor.name
    const at = ownPlace(placesOf(problem))
    return at === undefined ? { error } : { error, at }
  } catch {
    // A thrown object may have properties that throw.
    return { error: 'unknown' }
  }
}

/** Calls back into user code. `failed` gets the error that it throws or rejects with. */
export function callUser(call: () => unknown, failed: (problem: unknown) => void): void {
  try {
    const result = call()
    if (isLater(result)) Promise.resolve(result).catch(failed)
  } catch (problem) {
    failed(problem)
  }
}

/** Returns `true` for a promise of any class. */
export const isLater = (value: unknown): value is PromiseLike<unknown> =>
  typeof value === 'object' && value !== null && typeof (value as { then?: unknown }).then === 'function'
