// A decoded frame as named parts, for the byte view.

import { fieldOf, headerValue, hexByte, hexNumber, operationOf, sideOf, type Decoded, type HeaderField, type Protocol, type Text } from '../fc'

export interface Part extends Text {
  /** Name in the document. */
  name: string
  /** First byte and number of bytes. */
  offset: number
  size: number
  /** The value, spelled for a reader. */
  value: string
  /** `true` if it has an error. */
  fault?: boolean
}

/** Returns the meaning of a header field's number. */
function meaning(protocol: Protocol, field: HeaderField, value: number | null, decoded: Decoded): Text {
  if (field.role === 'kind') return protocol.kinds.find((kind) => kind.value === value) ?? field
  if (field.role === 'encoding') return protocol.encodings.find((encoding) => encoding.value === value) ?? field
  if (field.role === 'code') {
    const kindValue = headerValue(decoded, 'kind')
    const kind = protocol.kinds.find((candidate) => candidate.value === kindValue) ?? null
    const known = operationOf(protocol, value, kind)
    const range = protocol.ranges.find(({ first, last }) => value !== null && first <= value && value <= last)
    return known ?? range ?? field
  }
  if (field.role === 'head') {
    const side = sideOf(protocol, decoded)
    if (side !== null) return side === 'response' ? { zh: '响应', en: 'Response' } : { zh: '请求', en: 'Request' }
    return decoded.fault === 'bad_head' ? { zh: '不是帧头', en: 'Not a frame head' } : field
  }
  return field
}

const blames: Partial<Record<Decoded['verdicts'][number]['what'], HeaderField['role']>> = {
  head: 'head', length: 'total_length', kind: 'kind', encoding: 'encoding', digest: 'digest', inflate: 'plain_length',
}

/** Returns every byte of the frame with the field that owns it. */
export function partsOf(protocol: Protocol, decoded: Decoded): Part[] {
  const blamed = new Set(decoded.verdicts.filter(({ fault }) => fault).map(({ what }) => blames[what]))
  const parts = decoded.fields
    .filter(({ bytes }) => bytes.length > 0)
    .map(({ field, bytes, value }): Part => {
      const text = meaning(protocol, field, value, decoded)
      return {
        name: field.wire,
        offset: field.offset,
        size: bytes.length,
        value:
          value === null || field.role === 'head'
            ? Array.from(bytes, hexByte).join(field.size > 4 ? '' : ' ')
            : field.role === 'code'
              ? `${hexNumber(value, 4)} = ${value}`
              : field.size === 1
                ? hexNumber(value, 2)
                : String(value),
        zh: text.zh,
        en: text.en,
        fault: blamed.has(field.role),
      }
    })
  if (decoded.fault === 'bad_head') {
    // Without a head these bytes may not be a header at all.
    const [head] = parts.filter(({ name }) => name === fieldOf(protocol, 'head').wire)
    const offset = head ? head.offset + head.size : 0
    const size = decoded.bytes.length - offset
    const behind = { name: '…', offset, size, value: `${size} B`, zh: '不属于任何一帧', en: 'Not part of a frame' }
    return [...(head ? [head] : []), ...(size > 0 ? [behind] : [])]
  }
  if (decoded.data.length > 0) {
    const size = decoded.data.length
    parts.push({ name: 'Data', offset: protocol.headerLength, size, value: `${size} B`, zh: '数据区', en: 'Data area' })
  }
  if (decoded.rest.length > 0) {
    const size = decoded.rest.length
    parts.push({
      name: '…', offset: protocol.headerLength + decoded.data.length, size, value: `${size} B`,
      zh: '后面的字节，不属于这一帧', en: 'Bytes behind this frame',
    })
  }
  return parts
}
