// Bodies beyond the vectors: the lengths of decoded values, and the forms of a bool.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { readBody } from 'fc-protocol/codec'
import { bare, ofOneKey } from './support.mjs'

/** type, value, its length; `null` for an invalid value. */
const CASES = [
  ['string', '', 0],
  ['string', 'ab', 2],
  ['string', '机器', 2],
  ['string', '🤖🤖', 2],
  ['base64', '', 0],
  ['base64', 'AA==', 1],
  ['base64', 'AAA=', 2],
  ['base64', 'AAAA', 3],
  ['base64', 'AAAAAA==', 4],
  ['base64', 'A', null],
  ['base64', 'AA', null],
  ['base64', 'AAA', null],
  ['base64', 'AAAAA', null],
  ['base64', 'AA=A', null],
  ['base64', '=', null],
  ['base64', '==', null],
  ['base64', 'A===', null],
  ['base64', '====', null],
  // Spare bits that are not zero.
  ['base64', 'AB==', null],
  ['base64', 'AAB=', null],
  ['base64', 'AA-_', null],
]

for (const [type, value, length] of CASES) {
  test(`${type} '${value}'`, () => {
    const data = new TextEncoder().encode(JSON.stringify({ value }))
    const fault = (low, high) =>
      readBody(bare, ofOneKey(type, { length: [low, high] }), 'request', data).faults[0]?.name ?? null
    if (length === null) return assert.equal(fault(0, 9), 'bad_base64')
    assert.equal(fault(length, length), null)
    assert.equal(fault(length + 1, length + 1), 'bad_length')
    if (length > 0) assert.equal(fault(0, length - 1), 'bad_length')
  })
}

/** Forms of a bool: the JSON value, and if it is accepted as a bool, in a string and as a number. */
const BOOLS = [
  ['true', true, false, false],
  ['false', true, false, false],
  ['"true"', false, true, false],
  ['"false"', false, true, false],
  ['1', false, false, true],
  ['0', false, false, true],
  ['1.0', false, false, true],
  ['1e0', false, false, true],
  ['-0', false, false, true],
]

/** Values that are not a bool in any form. */
const NO_BOOLS = ['2', '-1', '0.5', '1e99', '"1"', '"0"', '"yes"', '""', '[]', '[1]', '{}']

const FORMS = [{}, { form: 'string' }, { form: 'number' }]

const faultOfBool = (constraints, value) => {
  const data = new TextEncoder().encode(`{"value":${value}}`)
  return readBody(bare, ofOneKey('bool', constraints), 'request', data).faults[0]?.name ?? null
}

for (const [value, ...taken] of BOOLS) {
  test(`a bool sent as ${value}`, () => {
    FORMS.forEach((form, index) => {
      assert.equal(faultOfBool(form, value), taken[index] ? null : 'wrong_type', JSON.stringify(form))
      assert.equal(faultOfBool({ ...form, lenientBool: true }, value), null, JSON.stringify(form))
    })
  })
}

for (const value of NO_BOOLS) {
  test(`no bool is sent as ${value}`, () => {
    for (const form of FORMS) {
      assert.equal(faultOfBool(form, value), 'wrong_type', JSON.stringify(form))
      assert.equal(faultOfBool({ ...form, lenientBool: true }, value), 'wrong_type', JSON.stringify(form))
    }
  })
}

/** Errors of enum values in a field that takes only some. */
const CHOICES = [
  // repr, closed, values, only, value, fault
  ['u8', false, [0, 1, 6], [1, 6], 1, null],
  ['u8', false, [0, 1, 6], [1, 6], 6, null],
  ['u8', false, [0, 1, 6], [1, 6], 0, 'out_of_range'],
  ['u8', false, [0, 1, 6], [1, 6], 99, 'out_of_range'],
  ['u8', true, [0, 1, 6], [1, 6], 0, 'out_of_range'],
  ['u8', true, [0, 1, 6], [1, 6], 99, 'unknown_value'],
  ['i8', false, [-3, 3], [-3], -3, null],
  ['i8', false, [-3, 3], [-3], 3, 'out_of_range'],
  ['string', false, ['day', 'night'], ['day'], 'day', null],
  ['string', false, ['day', 'night'], ['day'], 'night', 'out_of_range'],
  ['string', false, ['day', 'night'], ['day'], 'noon', 'out_of_range'],
  ['string', true, ['day', 'night'], ['day'], 'noon', 'unknown_value'],
]

/** Returns an enum with these values, named after themselves. */
const enumOf = (repr, closed, values) => () => ({
  is: 'enum',
  name: 'Inner',
  repr,
  closed,
  values: Object.fromEntries(values.map((value) => [String(value), value])),
})

for (const [repr, closed, values, only, value, fault] of CHOICES) {
  test(`${value} of ${closed ? 'a closed' : 'an open'} enum, where only ${only} is taken`, () => {
    const operation = ofOneKey(enumOf(repr, closed, values), { only })
    const report = readBody(bare, operation, 'request', new TextEncoder().encode(JSON.stringify({ value })))
    assert.deepEqual(
      report.faults.map(({ name }) => name),
      fault === null ? [] : [fault],
    )
    assert.deepEqual(report.unknown, [])
  })
}

/** A message with a list of parts. Each part has a value and an optional mode. */
const NESTED = {
  is: 'struct',
  name: 'Outer',
  fields: {
    parts: { key: 'parts', type: { list: () => PART } },
    name: { key: 'name', type: 'string', length: [1, 3], optional: true },
    last: { key: 'last', type: 'bool' },
  },
}
const PART = {
  is: 'struct',
  name: 'Part',
  fields: {
    value: { key: 'value', type: 'u8' },
    mode: { key: 'mode', type: enumOf('u8', false, [0, 1]), optional: true },
  },
}

/** Body, names and paths of its errors, paths of unknown keys and values. */
const SEVERAL = [
  [
    '{"parts":[{"value":256},{},{"value":"1","mode":9,"more":{}}],"name":"long","last":1,"x":[]}',
    [
      'out_of_range parts[0].value',
      'missing_field parts[1].value',
      'wrong_type parts[2].value',
      'wrong_type last',
      'bad_length name',
    ],
    ['parts[2].mode', 'parts[2].more', 'x'],
  ],
  ['{"last":true,"last":{"a":[1]},"parts":[1,2]}', ['duplicate_key last', 'wrong_type parts[0]'], []],
  ['{"parts":{"deep":[{}]}}', ['wrong_type parts', 'missing_field last'], []],
  ['[]', ['not_an_object '], []],
  ['{"parts":', ['bad_json '], []],
]

for (const [text, faults, unknown] of SEVERAL) {
  test(`the reader goes on behind each error of ${text}`, () => {
    const report = readBody(bare, { request: NESTED, response: null }, 'request', new TextEncoder().encode(text))
    assert.deepEqual(
      report.faults.map(({ name, path }) => `${name} ${path}`),
      faults,
    )
    assert.deepEqual(
      report.unknown.map(({ path }) => path),
      unknown,
    )
    assert.equal(report.isJson, faults[0] !== 'bad_json ')
    assert.equal(report.text, text)
  })
}
