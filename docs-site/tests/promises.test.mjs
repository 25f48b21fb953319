// The list of limits and settings agrees with the sources of each package. Each test named by a guarantee or a limit
// exists.

import assert from 'node:assert/strict'
import { existsSync, readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { root, site } from './support.mjs'

const camel = (name) => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase())

/** The files with the settings of each package, and the pattern of a setting. */
const PACKAGES = {
  Rust: {
    files: ['client/config', 'server/config', 'connection_settings', 'wire'].map((name) => `fc-runtime/src/${name}.rs`),
    setting: (name) => `^ +pub (?:fn ${name}\\(mut self|${name}: \\w+,)`,
  },
  TypeScript: {
    files: ['stubs/typescript/src/client/config.ts', 'stubs/typescript/src/server/config.ts', 'stubs/typescript/src/wire.ts'],
    setting: (name) => `^  readonly ${camel(name)}\\??:`,
  },
  Python: {
    files: ['stubs/python/src/fc_runtime/config.py', 'stubs/python/src/fc_runtime/protocol.py'],
    setting: (name) => `^    ${name}: `,
  },
  Kotlin: {
    files: ['stubs/kotlin/runtime/src/main/kotlin/fc/runtime/Config.kt', 'stubs/kotlin/runtime/src/main/kotlin/fc/runtime/Protocol.kt'],
    // A class, up to its closing brace.
    parts: /^public class (?:ClientConfig|ServerConfig|Limits)\b[^]*?^\}/gm,
    setting: (name) => `^    public fun ${camel(name)}\\(`,
  },
  'C++': {
    files: ['client', 'server', 'protocol'].map((name) => `stubs/cpp/include/fc_runtime/${name}.hpp`),
    parts: /^struct (?:ClientConfig|ServerConfig|Limits) \{[^]*?^\};/gm,
    setting: (name) => `^  [\\w:<>]+ ${name}(?: = .*|\\{.*\\})?;$`,
  },
}
const read = (file) => readFileSync(path.join(root, file), 'utf8')

/** The sources of a package's settings, without other parts of the files. */
function sources(language) {
  const { files, parts } = PACKAGES[language]
  const text = files.map(read).join('\n')
  if (!parts) return text
  const found = text.match(parts) ?? []
  assert.equal(found.length, 3, `client, server and limits of ${language}`)
  return found.join('\n')
}

const page = (folder) => readFileSync(path.join(site, folder, 'packages.md'), 'utf8')
const cells = (line) => line.split('|').slice(1, -1).map((cell) => cell.trim())

/** Settings that the section lists. */
function settings(folder) {
  const [, section] = /\{#limits\}\n([^]*?)\n##/.exec(page(folder))
  const items = section.split('\n').filter((line) => line.startsWith('- '))
  return items.flatMap((item) => Array.from(item.matchAll(/`(\w+)`/g), ([, name]) => name))
}

/** `LANGUAGE SETTING` of each setting that the table of features shows as missing. */
function missing(folder) {
  const [, section] = /\{#features\}\n([^]*?)\n##/.exec(page(folder))
  const [[, ...languages], , ...rows] = section.split('\n').filter((line) => line.startsWith('|')).map(cells)
  return rows.flatMap(([feature, ...marks]) => {
    const [, name] = /^`(\w+)`/.exec(feature) ?? []
    return name ? languages.filter((_, at) => marks[at] === '—').map((language) => `${language} ${name}`) : []
  })
}

for (const folder of ['guides', 'en/guides']) {
  test(`${folder}: each package has the limits and settings of the list, except those shown as missing`, () => {
    const absent = Object.keys(PACKAGES).flatMap((language) => {
      const text = sources(language)
      const has = (name) => new RegExp(PACKAGES[language].setting(name), 'm').test(text)
      return settings(folder).filter((name) => !has(name)).map((name) => `${language} ${name}`)
    })
    // Java uses the package for Kotlin.
    const shown = missing(folder).filter((one) => !one.startsWith('Java '))
    assert.deepEqual(shown.sort(), absent.sort())
  })

  test(`${folder}: no limit or setting of the Rust package is left out`, () => {
    const methods = PACKAGES.Rust.files.flatMap((file) => Array.from(read(file).matchAll(/^ +pub fn (\w+)\(mut self/gm), ([, name]) => name))
    const [, fields] = /^pub struct Limits \{([^]*?)^\}/m.exec(read('fc-runtime/src/wire.rs'))
    const limits = Array.from(fields.matchAll(/^ {4}pub (\w+):/gm), ([, name]) => name)
    const known = [...new Set([...methods, ...limits])].filter((name) => name !== 'limits')
    assert.ok(methods.length > 20 && limits.length > 5)
    assert.deepEqual(settings(folder).sort(), known.sort())
  })
}

const exists = (...names) => names.some((name) => existsSync(path.join(root, name)))
/** The sources of the tests of limits. */
const limits = readdirSync(path.join(root, 'fc-runtime/tests/it/limits')).map((name) => read(`fc-runtime/tests/it/limits/${name}`)).join('\n')
/** The commands of `load/`. */
const load = read('load/src/main.rs')

/** Returns `true` if a test exists, by its name in the last column of a table. */
function isTest(name) {
  const [, crate = 'fc-runtime', module] = /^(?:(fc-\w+) )?(\w+)::$/.exec(name) ?? []
  if (module) return exists(`${crate}/tests/it/${module}.rs`, `${crate}/tests/it/${module}/mod.rs`)
  const [, program, target] = /^(fuzz|load) (\w+)$/.exec(name) ?? []
  if (program === 'fuzz') return exists(`fuzz/fuzz_targets/${target}.rs`)
  if (program === 'load') return load.includes(`["${target}"] =>`)
  return exists(`fc-runtime/tests/${name}.rs`, `fc-runtime/tests/${name}/main.rs`) || new RegExp(`^(?:async )?fn ${name}\\(`, 'm').test(limits)
}

/** The names in the last column of tables that end with a column of tests. */
function named(folder, page) {
  const lines = readFileSync(path.join(site, folder, page), 'utf8').split('\n')
  let inTable = false
  return lines.flatMap((line) => {
    if (!line.startsWith('|')) inTable = false
    else if (/\| (?:Test|测试) \|$/.test(line)) inTable = true
    if (!inTable) return []
    const last = line.split('|').at(-2)
    return Array.from(last.replace(/\[[^\]]*\]\([^)]*\)/g, '').matchAll(/`([^`]+)`/g), ([, name]) => name)
  })
}

for (const [file, least] of [['promises.md', 50], ['limits.md', 20]]) {
  test(`${file}: every test that it names exists, and both languages name the same`, () => {
    const names = named('guides', file)
    assert.ok(names.length > least, `${names.length} names`)
    assert.deepEqual(named('en/guides', file), names)
    assert.deepEqual(names.filter((name) => !isTest(name)), [])
  })
}
