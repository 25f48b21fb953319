// Texts and numbers of JSON: `JSON.parse` rounds the 64-bit ids of this protocol.

/** What newer platforms have of their own. */
const { isWellFormed } = String.prototype as { isWellFormed?: (this: string) => boolean }

/** Whether it has half of a surrogate pair without the other. */
export const hasLoneSurrogate = (text: string): boolean =>
  isWellFormed ? !isWellFormed.call(text) : /\p{Surrogate}/u.test(text)

/** Digits that no integer type of the spec has, by far. */
const MANY_DIGITS = 40

/** The integer that a JSON number amounts to, exactly: `1.0` and `1e2` are integers. `null` for a fraction, and for what is
 * not a number. What is far beyond any type comes out as some number that is, too. */
export function integral(number: string): bigint | null {
  const found = /^(-?)(\d+)(?:\.(\d+))?(?:[eE]([+-]?\d+))?$/.exec(number)
  if (!found) return null
  const [, minus, whole = '', part = '', exponent = '0'] = found
  const all = (whole + part).replace(/^0+/, '')
  if (all === '') return 0n
  let end = all.length
  // No regular expression: from each zero on it would look for the end again.
  while (all[end - 1] === '0') end--
  const digits = all.slice(0, end)
  const power = Number(exponent) - part.length + all.length - end
  if (power < 0) return null
  const exact = digits.length + power > MANY_DIGITS ? 10n ** BigInt(MANY_DIGITS) : BigInt(digits) * 10n ** BigInt(power)
  return minus ? -exact : exact
}
