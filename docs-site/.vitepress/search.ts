// The local search: what of a page is found, by which terms, and which page comes first.
//
// VitePress ships the functions of the options to the browser as text, so `indexTerms`, `queryTerms`
// and `weight` must stand on their own: no imports, no helpers outside their body.

import type { DefaultTheme, MarkdownEnv, MarkdownRenderer } from 'vitepress'
import { protocol } from '../lab/generated/protocol'
import { navigation } from './navigation'

/**
 * Terms of a page: words and numbers as they are, names also in their parts (`robotSn` → `robot`,
 * `sn`), and every pair of neighbouring Chinese characters, since Chinese has no spaces to split at.
 */
export function indexTerms(text: string): string[] {
  const terms: string[] = []
  for (const run of text.match(/[A-Za-z0-9_]+|[\u3400-\u9fff\uf900-\ufaff]+/g) ?? []) {
    if (/^[A-Za-z0-9_]/.test(run)) {
      terms.push(run)
      const parts = run.split(/_+|(?<=[a-z0-9])(?=[A-Z])/).filter(Boolean)
      if (parts.length > 1) terms.push(...parts)
    } else {
      for (const character of run) terms.push(character)
      for (let at = 0; at + 1 < run.length; at++) terms.push(run.slice(at, at + 2))
    }
  }
  return terms
}

/**
 * Terms of a query: whole words and names, and Chinese as pairs; a single character only where the
 * query has no more, or every page would answer to 电 when asked for 充电.
 */
export function queryTerms(query: string): string[] {
  const terms: string[] = []
  for (const run of query.match(/[A-Za-z0-9_]+|[\u3400-\u9fff\uf900-\ufaff]+/g) ?? []) {
    if (/^[A-Za-z0-9_]/.test(run) || run.length === 1) terms.push(run)
    else for (let at = 0; at + 1 < run.length; at++) terms.push(run.slice(at, at + 2))
  }
  return terms
}

/** How much a hit counts by where it is: the head of an operation's page before all, lists last. */
export function weight(id: string, _term: string, stored?: Record<string, unknown>): number {
  const page = id.split('#')[0]
  let weight = 1
  if (/\/reference\/(commands|reports|streams)\//.test(page)) weight = 3
  else if (/\/reference\/(changelog|open-questions|codes)\.html$|\/reference\/$/.test(page)) weight = 0.4
  // A section under no other is the head of its page.
  const head = Array.isArray(stored?.titles) && stored.titles.length === 0
  return head ? weight * 3 : weight
}

/** The operation of a page, and the group that it stands in. */
function operationOf(page: string) {
  const found = /reference\/((?:commands|reports|streams)\/(\w+))\.md$/.exec(page)
  const operation = found && protocol.operations.find(({ name }) => name === found[2])
  const group = found && navigation.groups.find(({ items }) => items.some(({ link }) => link === found[1]))
  return operation && group ? { operation, group } : null
}

/** Sections that every operation's page has, and that say nothing of it alone. */
const COMMON = /^(?:rust|结果码|result-codes|出处|provenance)$/

/**
 * What of a page is searched. Of an operation: its name and code in the title, what its group is for,
 * and its tables; not its bytes, its samples and what stands on every such page.
 */
export function searched(source: string, env: MarkdownEnv, md: MarkdownRenderer): string {
  const html = md.render(source, env)
  if (env.frontmatter?.search === false) return ''
  const prose = html
    .replace(/<(FrameBytes|SequencePicture|DoorLayout|ByteRuler|QuestionFilter|FrameLab)\b[^>]*>/g, '')
    .replace(/<p class="fc-badges">[\s\S]*?<\/p>/g, '')
    .replace(/<div class="language-[\s\S]*?<\/pre>[\s\S]*?<\/div>/g, '')
  const found = operationOf(env.relativePath ?? '')
  if (!found) return prose
  const { operation, group } = found
  const code = operation.code === null ? [] : ['0x' + operation.code.toString(16).toUpperCase().padStart(4, '0'), String(operation.code)]
  const title = ['', operation.name, ...code].join(' · ')
  const language: 'zh' | 'en' = env.relativePath.startsWith('en/') ? 'en' : 'zh'
  const context = `<p>${group[language]} ${group.about?.[language] ?? ''}</p>`
  const [head, ...sections] = prose.split(/(?=<h2\b)/)
  const own = sections.filter((section) => !COMMON.test(/<h2 id="([^"]*)"/.exec(section)?.[1] ?? ''))
  return (
    head.replace(/( ?<a class="header-anchor"[\s\S]*?<\/h1>)/, `${title}$1${context}`) +
    // Frames and enums belong to the section above them.
    own.join('').replace(/<(\/?)h3\b[^>]*>/g, '<$1p>')
  )
}

export const searchOptions: DefaultTheme.LocalSearchOptions = {
  detailedView: false,
  _render: searched,
  miniSearch: {
    options: { tokenize: indexTerms },
    searchOptions: {
      tokenize: queryTerms,
      combineWith: 'AND',
      fuzzy: false,
      prefix: true,
      boost: { title: 6, titles: 2, text: 1 },
      boostDocument: weight,
    },
  },
  locales: {
    root: {
      translations: {
        button: { buttonText: '搜索', buttonAriaLabel: '搜索' },
        modal: {
          displayDetails: '显示详情',
          resetButtonTitle: '清除',
          backButtonTitle: '返回',
          noResultsText: '没有找到',
          footer: { selectText: '打开', navigateText: '切换', closeText: '关闭' },
        },
      },
    },
  },
}

