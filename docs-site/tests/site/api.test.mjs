// The reference of each package, written by the tool of its language, has every command. The guides link to it.

import assert from 'node:assert/strict'
import { existsSync, readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { faults, WITHOUT_COMMENT } from '../../api/doxygen.mjs'
import { dist, engine, needs, root } from '../support.mjs'
import { alive, driven, withSite } from './browser.mjs'
import { html } from './site-pages.mjs'

const folder = path.join(dist, 'api')
const camel = (name) => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase())

/** For each tool: the page with the client's methods, the spelling of a method, and the guide with the link. */
const REFERENCES = {
  rust: { page: 'fc_generated/struct.Client.html', method: (name) => `id="method.${name}"`, guide: 'first-call' },
  typescript: { page: 'classes/fc-protocol.Client.html', method: (name) => `id="${camel(name).toLowerCase()}"`, guide: 'first-call-typescript' },
  python: { page: 'fc.html', method: (name) => `id="Client.${name}"`, guide: 'first-call-python' },
  cpp: { page: 'classfc_1_1Client.html', method: (name) => `>${name}</a> (`, guide: 'first-call-cpp' },
}
const there = (language) => existsSync(path.join(folder, language))

for (const [language, { page, method, guide }] of Object.entries(REFERENCES)) {
  const built = needs(there(language), `needs npm run api ${language}`)

  test(`${language}: the client's page has every command`, built, async () => {
    const { protocol } = await engine()
    const commands = protocol.operations.filter(({ kind, code }) => kind === 'command' && code !== null)
    const text = readFileSync(path.join(folder, language, page), 'utf8')
    assert.deepEqual(commands.map(({ name }) => name).filter((name) => !text.includes(method(name))), [])
  })

  test(`${language}: its guide leads there, in both languages`, built, () => {
    for (const root of ['/guides', '/en/guides']) assert.ok(html(`${root}/${guide}.html`).includes(` href="/api/${language}/`), `${root}/${guide}`)
  })
}

test('every reference is looked at', needs(existsSync(folder), 'needs npm run api'), () => {
  assert.deepEqual(readdirSync(folder).filter((language) => !(language in REFERENCES)), [])
})

test('cpp: free functions of a namespace have a page', needs(there('cpp'), 'needs npm run api cpp'), () => {
  for (const [page, names] of [
    ['namespacefc.html', ['service', 'refusal', 'ResultCode']],
    ['namespacefc__runtime.html', ['declared', 'check_conditions', 'CallErrorKind']],
  ]) {
    const text = readFileSync(path.join(folder, 'cpp', page), 'utf8')
    assert.deepEqual(names.filter((name) => !new RegExp(`>${name}</[ab]>`).test(text)), [], page)
  }
})

test('cpp: items without a comment are listed, except constructors and operators', () => {
  const warning = (file, what) => `stubs/cpp/${file}:7: warning: ${what} is not documented.`
  const allowed = [
    warning('generated/include/fc/groups/cell.hpp', 'Member CellLocation(Value value) (function) of class fc::CellLocation'),
    warning('include/fc_runtime/result.hpp', 'Member operator->() const (function) of class fc_runtime::Result'),
    'stubs/cpp/generated/include/fc/groups/cell.hpp:7: warning: explicit link request to \'1\' could not be resolved',
  ]
  assert.deepEqual(faults(allowed.join('\n')), [])
  const generated = warning('generated/include/fc/client.hpp', 'Member close() const (function) of class fc::Client')
  const type = warning('generated/include/fc/client.hpp', 'Compound fc::Reports')
  const broken = 'stubs/cpp/include/fc_runtime/call.hpp:7: warning: unable to resolve reference'
  assert.deepEqual(faults([generated, type, broken].join('\n')), [generated, type, broken])
  const known = Array.from({ length: WITHOUT_COMMENT }, (_, at) => warning('include/fc_runtime/call.hpp', `Member field_${at} (variable) of struct fc_runtime::CallError`))
  assert.deepEqual(faults(known.join('\n')), [])
  assert.equal(faults([...known, known[0]].join('\n')).length, WITHOUT_COMMENT + 2)
})

test('kotlin: the guide and the build agree on having no pages', needs(existsSync(dist), 'needs npm run build'), () => {
  assert.doesNotMatch(readFileSync(path.join(root, 'stubs/kotlin/build.gradle.kts'), 'utf8'), /dokka/i)
  for (const guides of ['/guides', '/en/guides']) assert.match(html(`${guides}/first-call-kotlin.html`), /id="dokka"[^]*build\.gradle\.kts/)
})

test('a link leads out of the site into a reference', driven.skip ? driven : needs(there('typescript'), 'needs npm run api typescript'), async () => {
  await withSite(async ({ open }) => {
    const page = await open('/guides/first-call-typescript.html')
    await alive(page)
    await page.locator('a[href^="/api/typescript/"]').click()
    await page.waitForURL((now) => now.pathname.startsWith('/api/typescript/'))
    assert.match(await page.title(), /fc-protocol/)
  })
})
