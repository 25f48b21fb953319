// Rounding to 32-bit floats. JavaScript reads every number as a double, and rounding twice may give a wrong result.

/** Greater than the digits of any number half-way between two floats. */
const MANY_DIGITS = 200
/** Half-way between the largest float and the next power of two. Rounding it gives infinity. */
const PAST_THE_LARGEST = 2 ** 128 - 2 ** 103

const view = new DataView(new ArrayBuffer(8))

/** Returns `true` if a double is exactly half-way between two 32-bit floats. */
function isHalfWay(value: number): boolean {
  const nearest = Math.fround(value)
  if (nearest === value) return false
  // `other` is as far away as `nearest`, on the other side. If it is not a float, the value is not half-way.
  const other = 2 * value - nearest
  return Number.isFinite(nearest) ? Math.fround(other) === other : Math.abs(value) === PAST_THE_LARGEST
}

/** Compares a number's text with a double, ignoring both signs: -1 if the text is less, 1 if it is more. */
function order(text: string, bits: bigint): number {
  const [mantissa = '', exponent = '0'] = text.replace(/^-/, '').toLowerCase().split('e')
  const [whole = '', part = ''] = mantissa.split('.')
  let digits = (whole + part).replace(/^0+/, '')
  let ten = Number(exponent) - part.length
  if (digits.length > MANY_DIGITS) {
    ten += digits.length - MANY_DIGITS - 1
    const isMore = /[1-9]/.test(digits.slice(MANY_DIGITS))
    digits = digits.slice(0, MANY_DIGITS) + (isMore ? '1' : '0')
  }
  // Doubles half-way between two floats are large enough to have an implicit first bit.
  const two = Number((bits >> 52n) & 0x7ffn) - 1075
  const power = (base: bigint, of: number): bigint => base ** BigInt(Math.max(of, 0))
  const ours = BigInt(digits) * power(10n, ten) * power(2n, -two)
  const its = ((bits & ((1n << 52n) - 1n)) | (1n << 52n)) * power(2n, two) * power(10n, -ten)
  return ours < its ? -1 : ours > its ? 1 : 0
}

/**
 * Returns the double to round to 32 bits for a number's text. `value` is the nearest double. The text decides if
 * `value` is half-way between two floats.
 */
export function beforeRounding(text: string, value: number): number {
  if (!isHalfWay(value)) return value
  view.setFloat64(0, value)
  const bits = view.getBigUint64(0)
  view.setBigUint64(0, bits + BigInt(order(text, bits)))
  return view.getFloat64(0)
}
