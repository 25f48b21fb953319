// Texts and numbers of JSON: `JSON.parse` rounds the 64-bit ids of this protocol.

/** A method that only newer platforms have. */
const { isWellFormed } = String.prototype as { isWellFormed?: (this: string) => boolean }

/** Returns `true` if the text has one half of a surrogate pair without the other. */
export const hasLoneSurrogate = (text: string): boolean =>
  isWellFormed ? !isWellFormed.call(text) : /\p{Surrogate}/u.test(text)

/** Far more digits than any integer type needs. */
const MANY_DIGITS = 40

/**
 * Returns the exact integer value of a JSON number: `1.0` and `1e2` are integers. Returns `null` for a fraction or text
 * that is not a number. A number far outside every type yields another number that is also outside.
 */
export function integral(number: string): bigint | null {
  const found = /^(-?)(\d+)(?:\.(\d+))?(?:[eE]([+-]?\d+))?$/.exec(number)
  if (!found) return null
  const [, minus, whole = '', part = '', exponent = '0'] = found
  const all = (whole + part).replace(/^0+/, '')
  if (all === '') return 0n
  let end = all.length
  // A regular expression would look for the end again from each zero.
  while (all[end - 1] === '0') end--
  const digits = all.slice(0, end)
  const power = Number(exponent) - part.length + all.length - end
  if (power < 0) return null
  const exact = digits.length + power > MANY_DIGITS ? 10n ** BigInt(MANY_DIGITS) : BigInt(digits) * 10n ** BigInt(power)
  return minus ? -exact : exact
}
