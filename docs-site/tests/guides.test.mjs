// Runs the commands of each guide in a fresh copy of the project and compares the output with the page. Both languages
// must have the same commands and samples, and included files must exist. `BLESS=1` writes the output into the pages.

import assert from 'node:assert/strict'
import { execFileSync, spawnSync } from 'node:child_process'
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import path from 'node:path'
import { after, test } from 'node:test'
import { isDeepStrictEqual } from 'node:util'
import { needs, root, site } from './support.mjs'

/** The guides of this test: those with a handwritten Chinese and English page. */
const guides = readdirSync(path.join(site, 'guides'))
  .filter((name) => name.endsWith('.md'))
  .map((name) => name.slice(0, -'.md'.length))

/** The directory of the pages of each language. */
const FOLDERS = { zh: 'guides', en: 'en/guides' }

/** A fence: its ticks, its kind and its text. */
const FENCE = /^(`{3,})([^\n`]*)\n([\s\S]*?)^\1$/gm

/** The fences of a page, `{ info, text }`, and its included files. */
function parts(file) {
  const source = readFileSync(file, 'utf8')
  const fences = Array.from(source.matchAll(FENCE), ([, , info, text]) => ({ info: info.trim(), text }))
  const pulled = Array.from(source.matchAll(/^<<< (\S+?)(?:#(\w+))?(?:\{.*\})?$/gm), ([, name, region]) => ({
    file: path.relative(root, path.resolve(path.dirname(file), name)),
    region,
  }))
  return { fences, pulled }
}

/** The page of a guide in each language that has one: `{ lang, file, fences, pulled }`. */
function pagesOf(guide) {
  const pages = Object.entries(FOLDERS).map(([lang, folder]) => ({ lang, file: path.join(site, folder, `${guide}.md`) }))
  return pages.filter(({ file }) => existsSync(file)).map((page) => ({ ...page, ...parts(page.file) }))
}

/**
 * A fence without the language of its page. Commands may differ in `--lang zh` and `--lang en`. They may also differ in
 * `X.md` and `X.en.md` if both files exist. The output is compared with that of the page's own commands.
 */
function withoutLanguage({ info, text }) {
  if (info === 'text output') return { info }
  // `.ci/walk` writes the transcript, in the language of the page.
  if (info === 'text' && /^\$ fcproto /m.test(text)) return { info, text: text.split('\n').filter((line) => line.startsWith('$ ')) }
  return { info, text: info === 'sh' ? text.replace(/--lang (?:zh|en)\b/g, '--lang').replaceAll('.en.md', '.md') : text }
}

/** Writes the output of the commands into a page: texts by the position of their fence. */
function write(file, printed) {
  let position = 0
  const source = readFileSync(file, 'utf8')
  writeFileSync(file, source.replace(FENCE, (fence, ticks, info) => {
    const text = printed.get(position++)
    return text === undefined ? fence : `${ticks}${info}\n${text}${ticks}`
  }))
}

for (const guide of guides) {
  test(`${guide}: both languages show the same, and only what runs or is drawn`, () => {
    const pages = pagesOf(guide)
    assert.deepEqual(pages.map(({ lang }) => lang), Object.keys(FOLDERS), 'lacks a language')
    const [zh, en] = pages
    assert.deepEqual(en.fences.map(withoutLanguage), zh.fences.map(withoutLanguage))
    assert.deepEqual(en.pulled, zh.pulled)
    for (const { lang, fences } of pages) {
      for (const [position, { info, text }] of fences.entries()) {
        assert.ok(['sh', 'text output', 'text', 'fc-example', 'fc-frame', 'mermaid'].includes(info), `nothing proves a fence of ${info || 'no kind'}`)
        if (info === 'text output') assert.equal(fences[position - 1]?.info, 'sh', `${lang}: no command prints\n${text}`)
        if (info === 'sh') for (const [, spoken] of text.matchAll(/--lang (zh|en)\b/g)) assert.equal(spoken, lang, text)
      }
    }
    for (const { file, region } of zh.pulled) {
      const text = readFileSync(path.join(root, file), 'utf8')
      if (region) assert.match(text, new RegExp(`^ *(?:// ?#|# ?)region ${region}\\n[^]*^ *(?:// ?#|# ?)endregion ${region}\\n`, 'm'), `${file} has no region ${region}`)
    }
  })
}

/** The needs of all guides and of single guides: a name, and a command that succeeds if the need is met. */
const EVERY = Object.fromEntries(['cargo', 'bash', 'git', 'python3', 'npm'].map((tool) => [tool, [tool, '--version']]))
const SOME = {
  'first-call-kotlin': { 'a JDK': ['javac', '--version'] },
  'first-call-cpp': {
    cmake: ['cmake', '--version'],
    'a C++ compiler with zlib and Asio': ['c++', '-std=c++17', '-DASIO_STANDALONE', '-fsyntax-only', '-include', 'zlib.h', '-include', 'asio.hpp', '-x', 'c++', '/dev/null'],
  },
}
const lacking = (tools) => Object.keys(tools).filter((name) => spawnSync(tools[name][0], tools[name].slice(1)).status !== 0)
const missing = lacking(EVERY)

/**
 * Makes a folder a checkout with the current changes. It does not write unchanged files again, so that a guide can use
 * the builds of another one.
 */
function checkOut(folder) {
  const listed = execFileSync('git', ['ls-files', '-z', '--cached', '--others', '--exclude-standard'], { cwd: root, encoding: 'utf8', maxBuffer: 1 << 26 })
  const files = new Set(listed.split('\0').filter((file) => file && existsSync(path.join(root, file))))
  const folders = new Set(Array.from(files, (file) => path.dirname(file).split('/').map((_, at, steps) => steps.slice(0, at + 1).join('/'))).flat())
  for (const entry of readdirSync(folder, { recursive: true })) {
    if (!files.has(entry) && !folders.has(entry)) rmSync(path.join(folder, entry), { recursive: true, force: true })
  }
  for (const file of files) {
    const [from, to] = [path.join(root, file), path.join(folder, file)]
    if (existsSync(to) && readFileSync(from).equals(readFileSync(to))) continue
    mkdirSync(path.dirname(to), { recursive: true })
    copyFileSync(from, to)
  }
}

/**
 * Adapts a guide to a spec whose owner has already added the same names, perhaps by following the guide. Returns the
 * replacements for its commands and their output.
 */
function inThisSpec(folder) {
  const commands = path.join(folder, 'spec/commands')
  const spec = readdirSync(commands).map((name) => readFileSync(path.join(commands, name), 'utf8')).join('\n')
  const free = (name, taken) => (taken(name) ? free(`${name}_again`, taken) : name)
  const command = free('get_battery', (name) => new RegExp(`^  ${name}:`, 'm').test(spec))
  const group = free('battery', (name) => existsSync(path.join(commands, `${name}.yaml`)) || new RegExp(`\\bid: ${name}\\b`).test(spec))
  let code = 0x0a0e
  const spelled = () => `0x${code.toString(16).toUpperCase().padStart(4, '0')}`
  while (spec.toUpperCase().includes(spelled().toUpperCase())) code += 1
  return (text) =>
    text
      .replaceAll('get_battery', command)
      .replaceAll('spec/commands/battery.yaml', `spec/commands/${group}.yaml`)
      .replaceAll('id: battery\n', `id: ${group}\n`)
      .replaceAll('0x0A0E', spelled())
}

/** The folder and the builds of all guides. Builds of another folder would be useless to them. */
const target = path.join(process.env.CARGO_TARGET_DIR ?? path.join(root, 'target'), 'guides')
const folder = mkdtempSync(path.join(tmpdir(), 'fc-guides-'))
after(() => [folder, target].forEach((it) => rmSync(it, { recursive: true, force: true })))

for (const guide of guides) {
  const pages = pagesOf(guide)
  // A run counts for both pages if they have the same commands and outputs.
  const runs = pages.filter(({ fences }, at) => at === 0 || !isDeepStrictEqual(fences, pages[0].fences))
  const without = [...missing, ...lacking(SOME[guide] ?? {})]
  for (const { lang, fences } of runs) {
    if (!fences.some(({ info }) => info === 'sh')) continue
    const name = runs.length > 1 ? `${guide}, ${lang}` : guide
    test(`${name}: its commands run`, { ...needs(without.length === 0, `needs ${without.join(', ')}`), timeout: 1_200_000 }, () => {
      checkOut(folder)
      const here = inThisSpec(folder)
      const printed = new Map()
      for (const [position, { info, text: shown }] of fences.entries()) {
        if (info !== 'sh') continue
        const text = here(shown)
        const { status, stdout, stderr } = spawnSync('bash', ['-eu', '-c', text], {
          cwd: folder,
          encoding: 'utf8',
          env: { ...process.env, CARGO_TARGET_DIR: target, CARGO_TERM_COLOR: 'never', CARGO_TERM_QUIET: 'true', LC_ALL: 'C.UTF-8', NO_COLOR: '1' },
          maxBuffer: 1 << 26,
        })
        assert.equal(status, 0, `${text}\n${stdout}\n${stderr}`)
        const expected = fences[position + 1]
        if (expected?.info !== 'text output') continue
        if (process.env.BLESS && here(expected.text) === expected.text) printed.set(position + 1, stdout)
        else assert.equal(stdout, here(expected.text), text)
      }
      if (printed.size === 0) return
      for (const page of pages) if (isDeepStrictEqual(page.fences, fences)) write(page.file, printed)
    })
  }
}
