// The YAML of the spec as pages, so that every "defined in" leads to its place.

import { readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { fileURLToPath } from 'node:url'

const folder = fileURLToPath(new URL('../../spec', import.meta.url))

/** Root-relative names of the spec's files without their ending, `commands/cell`. */
export function specFiles(): string[] {
  const files = readdirSync(folder, { recursive: true, encoding: 'utf8' })
  return files
    .map((file) => file.split(path.sep).join('/'))
    .filter((file) => file.endsWith('.yaml'))
    .map((file) => file.slice(0, -'.yaml'.length))
    .sort()
}

/**
 * Names of places in a file, and the line (from 0) on which each stands: sections (`frame`), their entries
 * (`commands.get_station`), and answers by the first of their ids (`C040`, the next of them `C040.2`). The
 * generator links by these names, since line numbers in committed pages would change with every edit above them.
 */
export function specPlaces(text: string): Map<number, string[]> {
  const places = new Map<number, string[]>()
  const place = (line: number, name: string) => places.set(line, [...(places.get(line) ?? []), name])
  const answered = new Map<string, number>()
  const lines = text.split('\n')
  let section = ''
  let depth = 0
  lines.forEach((line, index) => {
    const [, indent, quoted, plain] = /^( *)(?:"([^"]+)"|'?([\w-]+)'?):(?:\s|$)/.exec(line) ?? []
    const key = quoted ?? plain
    if (key && !indent) {
      ;[section, depth] = [key, 0]
      place(index, section)
    } else if (key && section) {
      depth ||= indent.length
      if (indent.length === depth) place(index, `${section}.${key}`)
    }
    // `ids: [C040, C041]`, or as a list below.
    const list = line.trimEnd().endsWith('ids:') ? `${line} ${lines[index + 1] ?? ''}` : line
    for (const [, id] of list.matchAll(/(?<![\w#])ids: *\[? *(?:- *)?["']?([\w-]+)/g)) {
      const count = (answered.get(id) ?? 0) + 1
      answered.set(id, count)
      place(index, count === 1 ? id : `${id}.${count}`)
    }
  })
  return places
}

/** The text of a file of the spec. */
export const specText = (file: string) => readFileSync(path.join(folder, `${file}.yaml`), 'utf8').trimEnd()

/** One page a file. Its fence names the file: VitePress would obey an `@include` in a text of it. */
export const specPages = () =>
  specFiles().map((file) => ({ params: { file, title: `spec/${file}.yaml` }, content: `\`\`\`fc-source\n${file}\n\`\`\`` }))
