// Groups and their operations in both languages. `fcproto generate` writes them next to the pages.

import { existsSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'

interface Text {
  zh: string
  en: string
}

export interface Navigation {
  groups: (Text & {
    about: Text | null
    items: (Text & { link: string; code: string | null; kind: 'command' | 'report' | 'stream' })[]
  })[]
}

const file = fileURLToPath(new URL('../reference/navigation.json', import.meta.url))

export const navigation: Navigation = existsSync(file) ? JSON.parse(readFileSync(file, 'utf8')) : { groups: [] }
