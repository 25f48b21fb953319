// The guides do as they say: their commands run in a fresh copy of the project and print what the
// guide shows, both languages have the same commands and samples, and what is pulled in exists.

import assert from 'node:assert/strict'
import { execFileSync, spawnSync } from 'node:child_process'
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import path from 'node:path'
import { after, test } from 'node:test'
import { needs, root, site } from './support.mjs'

/** Guides that this test looks after: those with a Chinese and an English text written here. */
const guides = readdirSync(path.join(site, 'guides'))
  .filter((name) => name.endsWith('.md'))
  .map((name) => name.slice(0, -'.md'.length))

/** The fences of a guide, `{ info, text }`, and the files it pulls in. */
function parts(file) {
  const source = readFileSync(file, 'utf8')
  const fences = Array.from(source.matchAll(/^(`{3,})([^\n`]*)\n([\s\S]*?)^\1$/gm), ([, , info, text]) => ({ info: info.trim(), text }))
  const pulled = Array.from(source.matchAll(/^<<< (\S+?)(?:#(\w+))?(?:\{.*\})?$/gm), ([, name, region]) => ({
    file: path.relative(root, path.resolve(path.dirname(file), name)),
    region,
  }))
  return { fences, pulled }
}

for (const guide of guides) {
  test(`${guide}: both languages show the same, and only what runs or is drawn`, () => {
    const english = path.join(site, 'en/guides', `${guide}.md`)
    assert.ok(existsSync(english), 'has no English text')
    const zh = parts(path.join(site, 'guides', `${guide}.md`))
    const en = parts(english)
    assert.deepEqual(en, zh)
    for (const { info } of zh.fences) {
      assert.ok(['sh', 'text output', 'text', 'fc-example', 'fc-frame', 'mermaid'].includes(info), `nothing proves a fence of ${info || 'no kind'}`)
    }
    for (const { file, region } of zh.pulled) {
      const text = readFileSync(path.join(root, file), 'utf8')
      if (region) assert.match(text, new RegExp(`^ *(?:// ?#|# ?)region ${region}\\n[^]*^ *(?:// ?#|# ?)endregion ${region}\\n`, 'm'), `${file} has no region ${region}`)
    }
  })
}

/** What every guide needs, and what some need beside: a name, and the command that succeeds where it is there. */
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
 * Makes a folder what git has, and what it would: a checkout with the changes at hand. Files that are right already
 * are left as they are, so that commands of one guide find what those of another have compiled.
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
 * What a guide adds to the spec gives way to what its owner has added in the same words, perhaps by
 * following the guide: returns how its commands and what they print are to be read here.
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

/** What the commands of all guides work in, and what they compile: builds of another folder would be of no use to them. */
const target = path.join(process.env.CARGO_TARGET_DIR ?? path.join(root, 'target'), 'guides')
const folder = mkdtempSync(path.join(tmpdir(), 'fc-guides-'))
after(() => [folder, target].forEach((it) => rmSync(it, { recursive: true, force: true })))

for (const guide of guides) {
  const { fences } = parts(path.join(site, 'guides', `${guide}.md`))
  if (!fences.some(({ info }) => info === 'sh')) continue
  const without = [...missing, ...lacking(SOME[guide] ?? {})]
  test(`${guide}: its commands run`, { ...needs(without.length === 0, `needs ${without.join(', ')}`), timeout: 1_200_000 }, () => {
    checkOut(folder)
    const here = inThisSpec(folder)
    fences.forEach(({ info, text: shown }, index) => {
      if (info !== 'sh') return
      const text = here(shown)
      const { status, stdout, stderr } = spawnSync('bash', ['-eu', '-c', text], {
        cwd: folder,
        encoding: 'utf8',
        env: { ...process.env, CARGO_TARGET_DIR: target, CARGO_TERM_COLOR: 'never', CARGO_TERM_QUIET: 'true', NO_COLOR: '1' },
        maxBuffer: 1 << 26,
      })
      assert.equal(status, 0, `${text}\n${stdout}\n${stderr}`)
      const expected = fences[index + 1]
      if (expected?.info === 'text output') assert.equal(stdout, here(expected.text), text)
    })
  })
}
