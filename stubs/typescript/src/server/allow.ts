// Addresses that apps may connect from, and the commands they may call.

import type { Effect } from '../operation.ts'

/** Apps of a network, and the commands they may call. */
export interface Allowed {
  /** An address or a network, such as `10.0.0.0/24` or `fd00::/8`. */
  readonly network: string
  /** The effects of the commands that may be called from there. */
  readonly effects: 'all' | readonly Effect[]
}

interface Network {
  readonly bytes: readonly number[]
  readonly bits: number
  readonly effects: 'all' | readonly Effect[]
}

/**
 * Returns the four or sixteen bytes of an address; `null` for any other text. An IPv4 address mapped into IPv6 gives
 * four bytes.
 */
export function addressBytes(text: string): number[] | null {
  const mapped = /^::ffff:([0-9.]+)$/i.exec(text)
  const four = (mapped?.[1] ?? text).split('.')
  if (four.length === 4) {
    const bytes = four.map((part) => (/^[0-9]{1,3}$/.test(part) ? Number(part) : 256))
    return bytes.every((byte) => byte < 256) ? bytes : null
  }
  const halves = (text.split('%')[0] ?? '').split('::')
  if (halves.length > 2 || !text.includes(':')) return null
  const groups = halves.map((half) => (half === '' ? [] : half.split(':')))
  const given = groups.reduce((sum, { length }) => sum + length, 0)
  if (given > 8 || (halves.length === 1 && given !== 8)) return null
  const zeros = Array.from({ length: 8 - given }, () => '0')
  const all = halves.length === 1 ? (groups[0] ?? []) : [...(groups[0] ?? []), ...zeros, ...(groups[1] ?? [])]
  if (!all.every((group) => /^[0-9a-f]{1,4}$/i.test(group))) return null
  return all.flatMap((group) => [Number.parseInt(group, 16) >> 8, Number.parseInt(group, 16) & 0xff])
}

function networkOf({ network, effects }: Allowed): Network {
  const [address = '', length] = network.split('/')
  const bytes = addressBytes(address)
  const bits = length === undefined ? (bytes?.length ?? 0) * 8 : Number(length)
  if (!bytes || !/^[0-9]{1,3}$/.test(length ?? '0') || bits > bytes.length * 8) {
    throw new TypeError(`${network} is neither an address nor a network`)
  }
  return { bytes, bits, effects }
}

function holds({ bytes, bits }: Network, address: readonly number[]): boolean {
  if (bytes.length !== address.length) return false
  return bytes.every((byte, index) => {
    const own = Math.min(8, Math.max(0, bits - 8 * index))
    const mask = (0xff << (8 - own)) & 0xff
    return (byte & mask) === ((address[index] ?? 0) & mask)
  })
}

/** Rules for the addresses of apps. */
export class Access {
  private readonly networks: readonly Network[] | null

  /**
   * Creates the rules. Without networks, every address may do everything. Throws a `TypeError` for an invalid network.
   */
  constructor(allowed: readonly Allowed[] | undefined) {
    this.networks = allowed?.map(networkOf) ?? null
  }

  /**
   * Returns the effects allowed from an address; `null` if it may not connect. The smallest matching network counts.
   */
  effects(address: string): 'all' | readonly Effect[] | null {
    if (!this.networks) return 'all'
    const bytes = addressBytes(address)
    if (!bytes) return null
    const own = this.networks.filter((network) => holds(network, bytes))
    const [smallest] = own.sort((a, b) => b.bits - a.bits)
    return smallest?.effects ?? null
  }
}
