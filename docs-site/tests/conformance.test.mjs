// The table of cases per language agrees with the files of the cases and with the READMEs of the packages.

import assert from 'node:assert/strict'
import { execFileSync } from 'node:child_process'
import { readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { root, site } from './support.mjs'

const program = (...options) => execFileSync('python3', [path.join(root, 'conformance/table'), ...options], { encoding: 'utf8' })

/** `{ cells, languages }` of a page: the rows of its table by kind. */
function table(folder) {
  const lines = readFileSync(path.join(site, folder, 'porting.md'), 'utf8').split('\n')
  const from = lines.findIndex((line) => line.includes('{#table}'))
  const begin = lines.findIndex((line, at) => at > from && line.startsWith('|'))
  const end = lines.findIndex((line, at) => at > begin && !line.startsWith('|'))
  const [[, , ...languages], , ...rows] = lines.slice(begin, end).map((line) => line.split('|').slice(1, -1).map((cell) => cell.trim()))
  const cells = rows.map(([what, number, ...marks]) => [/`(\w+)`$/.exec(what)?.[1], { number, marks }])
  return { languages, cells: Object.fromEntries(cells) }
}

for (const folder of ['guides', 'en/guides']) {
  test(`${folder}: there are as many cases of each kind as the table says`, () => {
    const totals = JSON.parse(program('--totals'))
    const { cells } = table(folder)
    assert.deepEqual(Object.keys(cells), Object.keys(totals))
    for (const [kind, { number }] of Object.entries(cells)) {
      const said = Number(number.replace(/[,+]/g, ''))
      // Each command of the spec adds cases. A number on the page would be wrong after the next command.
      if (kind === 'accepted' || kind === 'rejected') assert.ok(number.endsWith('+') && totals[kind] >= said, `${kind}: ${number}`)
      else assert.equal(said, totals[kind], kind)
    }
  })

  test(`${folder}: the table leaves out what the packages do, and nothing else`, () => {
    const packages = JSON.parse(program('--left-out'))
    const { languages, cells } = table(folder)
    assert.deepEqual(languages, Object.keys(packages))
    for (const [column, language] of languages.entries()) {
      for (const [kind, { marks }] of Object.entries(cells)) {
        assert.equal(marks[column], packages[language].includes(kind) ? '—' : '✓', `${kind} in ${language}`)
      }
    }
  })
}
