// The YAML of the spec as pages. Each "defined in" links to its line.

import { readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { fileURLToPath } from 'node:url'

const folder = fileURLToPath(new URL('../../spec', import.meta.url))

/** Names of the spec's files relative to the root, without their extension: `commands/cell`. */
export function specFiles(): string[] {
  const files = readdirSync(folder, { recursive: true, encoding: 'utf8' })
  return files
    .map((file) => file.split(path.sep).join('/'))
    .filter((file) => file.endsWith('.yaml'))
    .map((file) => file.slice(0, -'.yaml'.length))
    .sort()
}

/**
 * Names of positions in a file, with their lines (from 0). A name is a section (`frame`), an entry
 * (`commands.get_station`), or the first id of an answer (`C040`, then `C040.2`). The generator links by name, because
 * line numbers in committed pages would change with each edit above them.
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

/** One page per file. Its fence has the file's name instead of its text, because VitePress would obey an `@include`. */
export const specPages = () =>
  specFiles().map((file) => ({ params: { file, title: `spec/${file}.yaml` }, content: `\`\`\`fc-source\n${file}\n\`\`\`` }))
