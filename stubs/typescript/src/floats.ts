// Floats of 32 bits: JavaScript reads every number as a double, and to round twice may round wrongly.

/** More digits than any number half-way between two floats has. */
const MANY_DIGITS = 200
/** Half-way between the largest float and the one that would come next: rounded, this is infinite. */
const PAST_THE_LARGEST = 2 ** 128 - 2 ** 103

const view = new DataView(new ArrayBuffer(8))

/** Whether a double is exactly half-way between two floats of 32 bits. */
function isHalfWay(value: number): boolean {
  const nearest = Math.fround(value)
  if (nearest === value) return false
  // As far on the other side as the nearest is on this one: closer than half-way, no float is there.
  const other = 2 * value - nearest
  return Number.isFinite(nearest) ? Math.fround(other) === other : Math.abs(value) === PAST_THE_LARGEST
}

/** Whether the text of a number stands for less (-1) or more (1) than a double, the signs of both aside. */
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
  // No double that is half-way between two floats is so small that its first bit is not there.
  const two = Number((bits >> 52n) & 0x7ffn) - 1075
  const power = (base: bigint, of: number): bigint => base ** BigInt(Math.max(of, 0))
  const ours = BigInt(digits) * power(10n, ten) * power(2n, -two)
  const its = ((bits & ((1n << 52n) - 1n)) | (1n << 52n)) * power(2n, two) * power(10n, -ten)
  return ours < its ? -1 : ours > its ? 1 : 0
}

/** What to round to 32 bits for the number of a text. `value` is the nearest double; half-way between two floats, the text decides. */
export function beforeRounding(text: string, value: number): number {
  if (!isHalfWay(value)) return value
  view.setFloat64(0, value)
  const bits = view.getBigUint64(0)
  view.setBigUint64(0, bits + BigInt(order(text, bits)))
  return view.getFloat64(0)
}
