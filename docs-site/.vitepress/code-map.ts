// Unused command codes: their ranges, and the purpose of each range.

import { hexNumber, protocol } from '../lab/fc'

/** A run of consecutive codes of one range, all without an operation. */
export interface UnusedRun {
  first: number
  last: number
  /** The place of the range in the protocol. */
  range: number
}

/** The anchor of a code on the page of codes. */
export const codeAnchor = (code: number) => `0x${hexNumber(code, 4).slice(2).toLowerCase()}`

/** New operations take their codes only from these ranges. */
const OPEN = ['commands', 'reports']
export const isOpen = ({ use }: { use: string }) => OPEN.includes(use)

/** The runs of unused codes of all ranges, in the order of the ranges. `taken` has the used and the retired codes. */
export function unusedRuns(taken: Set<number>): UnusedRun[] {
  const runs: UnusedRun[] = []
  protocol.ranges.forEach(({ first, last }, range) => {
    for (let code = first; code <= last; code++) {
      if (taken.has(code)) continue
      const run = runs.at(-1)
      if (run?.range === range && run.last === code - 1) run.last = code
      else runs.push({ first: code, last: code, range })
    }
  })
  return runs
}

/** The next free code of a range, as `fcproto new` finds it: the one after the largest taken code, or the first gap. */
export function nextFree(range: number, taken: Set<number>): number | undefined {
  const { first, last } = protocol.ranges[range]
  const all = Array.from({ length: last - first + 1 }, (_, offset) => first + offset)
  const free = all.filter((code) => !taken.has(code))
  return free.find((code) => !all.some((other) => other > code && taken.has(other))) ?? free[0]
}

/** Blocks of codes outside of all ranges: `0x12xx` for 256 of them, `0x123x` for 16, and single ones. */
export function outsideBlocks(): string[] {
  const isOutside = (code: number) => !protocol.ranges.some(({ first, last }) => first <= code && code <= last)
  const all = (from: number, count: number) => Array.from({ length: count }, (_, offset) => from + offset).every(isOutside)
  const blocks: string[] = []
  for (let code = 0; code < 0x10000; ) {
    const digits = codeAnchor(code)
    const size = code % 256 === 0 && all(code, 256) ? 256 : code % 16 === 0 && all(code, 16) ? 16 : 1
    if (size > 1) blocks.push(digits.slice(0, size === 256 ? -2 : -1) + (size === 256 ? 'xx' : 'x'))
    else if (isOutside(code)) blocks.push(digits)
    code += size
  }
  return blocks
}
