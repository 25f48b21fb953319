// The local search: what of a page is found. By which terms, and which page comes first, is in `search-terms.ts`.

import type { DefaultTheme, MarkdownEnv, MarkdownRenderer } from 'vitepress'
import { hexNumber, protocol } from '../lab/fc'
import { navigation } from './navigation'
import { miniSearch } from './search-terms'

/** The operation of a page, and the group that it stands in. */
function operationOf(page: string) {
  const found = /reference\/((?:commands|reports|streams)\/(\w+))\.md$/.exec(page)
  const operation = found && protocol.operations.find(({ name }) => name === found[2])
  const group = found && navigation.groups.find(({ items }) => items.some(({ link }) => link === found[1]))
  return operation && group ? { operation, group } : null
}

/** Sections that every operation's page has, and that say nothing of it alone. */
const COMMON = /^(?:代码|code|结果码|result-codes|出处|provenance)$/

/**
 * What of a page is searched. Of an operation: its name and code in the title, what its group is for,
 * and its tables; not its bytes, its samples and what stands on every such page.
 */
export function searched(source: string, env: MarkdownEnv, md: MarkdownRenderer): string {
  const html = md.render(source, env)
  if (env.frontmatter?.search === false) return ''
  const aliases: string[] = env.frontmatter?.aliases ?? []
  const prose = html
    .replace(/<br>/g, ' ')
    // What a guide is also looked for by; a generated page says so itself.
    .replace('</h1>', aliases.length ? `</h1><p>${aliases.join(' · ')}</p>` : '</h1>')
    .replace(/<(FrameBytes|SequencePicture|StatePicture|DoorLayout|ByteRuler|QuestionFilter|AudienceFilter|FrameLab)\b[^>]*>/g, '')
    .replace(/<p class="fc-badges">[\s\S]*?<\/p>/g, '')
    .replace(/<div class="language-[\s\S]*?<\/pre>[\s\S]*?<\/div>/g, '')
    .replace(/<div class="fc-samples"[^>]*>(?:<input[^>]*><label[^>]*>[^<]*<\/label>)*/g, '<div>')
  const found = operationOf(env.relativePath ?? '')
  if (!found) return prose
  const { operation, group } = found
  const code = operation.code === null ? [] : [hexNumber(operation.code, 4), String(operation.code)]
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
  miniSearch,
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

