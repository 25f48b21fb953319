// The summary of performance has the figures of the results and lists every missed target.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { site } from './support.mjs'

/** `{ target, must, measured, verdict }` of the rows that name a target; the columns are identified by their order. */
function targets(folder, page, columns) {
  const lines = readFileSync(path.join(site, folder, page), 'utf8').split('\n')
  const rows = lines.filter((line) => line.startsWith('|')).map((line) => line.split('|').slice(1, -1).map((cell) => cell.trim()))
  const all = rows.map((cells) => Object.fromEntries(columns.map((name, at) => [name, cells[at]])))
  return all.filter(({ target }) => /^[A-Z]\d+$/.test(target ?? '')).map(({ target, must, measured, verdict }) => [target, must, measured, verdict].join(' '))
}

for (const folder of ['guides', 'en/guides']) {
  test(`${folder}: the summary has the figures of the results`, () => {
    const results = targets(folder, 'performance-results.md', ['target', 'what', 'must', 'stretch', 'measured', 'verdict'])
    const summary = targets(folder, 'performance.md', ['what', 'measured', 'must', 'verdict', 'target'])
    assert.ok(results.length > 50 && summary.length > 20)
    const old = summary.filter((row) => !results.includes(row))
    assert.deepEqual(old, [], 'not in the results')
    const missed = results.filter((row) => row.includes('**') && !summary.includes(row))
    assert.deepEqual(missed, [], 'missed, and not in the summary')
  })
}
