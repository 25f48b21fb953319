// Checks of settings and call options. Each setting has a check, and none takes effect before all have passed.

/** Throws a `TypeError` for a value of another type, and a `RangeError` for a number out of range. */
export type Check = (name: string, value: unknown) => void

/** A check for each setting of a type. A setting without a check does not compile. */
export type ChecksOf<Settings> = { readonly [Name in keyof Settings]-?: Check }

/** Returns a value as an error message shows it. */
function shown(value: unknown): string {
  if (typeof value === 'string') return JSON.stringify(value.slice(0, 40))
  if (typeof value === 'function') return 'a function'
  if (typeof value !== 'object' || value === null) return String(value)
  return Array.isArray(value) ? 'a list' : 'an object'
}

const wrong = (name: string, value: unknown, expected: string): string =>
  `\`${name}\` is ${shown(value)}, expected ${expected}`

/** A number for which `isIn` returns `true`. */
function number(expected: string, isIn: (value: number) => boolean): Check {
  return (name, value) => {
    if (typeof value !== 'number') throw new TypeError(wrong(name, value, expected))
    if (!isIn(value)) throw new RangeError(wrong(name, value, expected))
  }
}

/** A value for which `isOne` returns `true`. */
export function kind(expected: string, isOne: (value: unknown) => boolean): Check {
  return (name, value) => {
    if (!isOne(value)) throw new TypeError(wrong(name, value, expected))
  }
}

/** An integer of a range. */
export const integer = (least: number, most: number = Number.MAX_SAFE_INTEGER): Check =>
  number(
    most === Number.MAX_SAFE_INTEGER ? `an integer from ${least}` : `an integer from ${least} to ${most}`,
    (value) => Number.isSafeInteger(value) && value >= least && value <= most,
  )

/** A time in milliseconds. It is finite: `null` means "no limit" where a setting allows that. */
export const duration: Check = number(
  'a number of milliseconds from 0',
  (value) => Number.isFinite(value) && value >= 0,
)

/** A finite number from 0. */
export const rate: Check = number('a number from 0', (value) => Number.isFinite(value) && value >= 0)

/** `true` or `false`. */
export const flag: Check = kind('true or false', (value) => typeof value === 'boolean')

/** A function. */
export const callback: Check = kind('a function', (value) => typeof value === 'function')

/** The name or address of a host. It must not be empty, since platforms accept an empty one. */
export const host: Check = kind('a name or address', (value) => typeof value === 'string' && value.trim() !== '')

/** A list whose items pass a check. */
export const listOf =
  (item: Check): Check =>
  (name, value) => {
    if (!Array.isArray(value)) throw new TypeError(wrong(name, value, 'a list'))
    for (const [index, one] of value.entries()) item(`${name}[${index}]`, one)
  }

/** A value that passes a check, or `null`. */
export const orNull =
  (check: Check): Check =>
  (name, value) => {
    if (value !== null) check(name, value)
  }

/** Settings in an object. An absent or `undefined` setting keeps its default. */
export function group<Settings>(checks: ChecksOf<Settings>): Check {
  const all = Object.entries<Check>(checks)
  return (name, value) => {
    if (typeof value !== 'object' || value === null || Array.isArray(value)) {
      throw new TypeError(wrong(name, value, 'an object'))
    }
    for (const [key, check] of all) {
      const setting = (value as Readonly<Record<string, unknown>>)[key]
      if (setting !== undefined) check(`${name}.${key}`, setting)
    }
  }
}
