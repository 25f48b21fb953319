// The local search: the searched part of each page. `search-terms.ts` has the terms and the order of hits.

import type { DefaultTheme, MarkdownEnv, MarkdownRenderer } from 'vitepress'
import { hexNumber, protocol } from '../lab/fc'
import { codeAnchor, isOpen, outsideBlocks, unusedRuns } from './code-map'
import { html } from './markdown/html'
import { navigation } from './navigation'
import { HIDDEN, miniSearch } from './search-terms'

/** The operation of a page and its group. */
function operationOf(page: string) {
  const found = /reference\/((?:commands|reports|streams)\/(\w+))\.md$/.exec(page)
  const operation = found && protocol.operations.find(({ name }) => name === found[2])
  const group = found && navigation.groups.find(({ items }) => items.some(({ link }) => link === found[1]))
  return operation && group ? { operation, group } : null
}

/** The names of an operation, its messages and its handlers in the packages, from the samples of its page. */
function namesIn(page: string, operation: string): string {
  const bare = (name: string) => name.replaceAll('_', '').toLowerCase()
  const samples = page.match(/<pre\b[\s\S]*?<\/pre>/g)?.join(' ').replace(/<[^>]*>/g, '') ?? ''
  const names = new Set(samples.match(/[A-Za-z_]\w*/g)?.filter((name) => bare(name).includes(bare(operation))))
  return [...names].join(' ')
}

/** Sections for the page of codes: one for each unused code, and one for all codes outside of the ranges. */
function unusedCodes(page: string, language: 'zh' | 'en'): string {
  const say = (zh: string, en: string) => (language === 'en' ? en : zh)
  const section = (anchor: string, title: string, text: string, terms: string) =>
    `<h2 id="${anchor}" tabindex="-1">${title} <a class="header-anchor" href="#${anchor}"></a></h2><p>${html(text)} ${HIDDEN}${terms}</p>`
  const taken = new Set(Array.from(page.matchAll(/<tr id="0x([0-9a-f]{4})"/g), ([, hex]) => Number.parseInt(hex, 16)))
  const unused = unusedRuns(taken).flatMap(({ first, last, range }) => {
    const { use, [language]: about } = protocol.ranges[range]
    const text = isOpen({ use })
      ? use === 'commands'
        ? say('可用：没有接口使用，可以分配给新指令。', 'Free: no operation has it. A new command may take it.')
        : say('可用：没有接口使用，可以分配给新上报。', 'Free: no operation has it. A new report may take it.')
      : say(`没有接口使用，也不再分配。号段：${about}`, `No operation has it, and new ones must not take it. Range: ${about}`)
    return Array.from({ length: last - first + 1 }, (_, offset) => {
      const code = first + offset
      return section(codeAnchor(code), `${hexNumber(code, 4)} = ${code}`, text, '')
    })
  })
  const outside = section(
    'outside',
    say('号段以外的功能码', 'Codes outside of all ranges'),
    say('没有接口使用，不在任何号段中，不要分配。', 'No operation has such a code, and no range includes it: do not use it.'),
    outsideBlocks().join(' '),
  )
  return unused.join('') + outside
}

/** Sections that are nearly the same on the page of every operation. */
const COMMON = /^(?:code|result-codes|provenance)$/

/**
 * The searched part of a page. An operation is found by name and code in its title, by the purpose of its group and by
 * its tables. Its bytes, its samples and the sections that all operations share are left out.
 */
export function searched(source: string, env: MarkdownEnv, md: MarkdownRenderer): string {
  const page = md.render(source, env)
  if (env.frontmatter?.search === false) return ''
  const aliases: string[] = env.frontmatter?.aliases ?? []
  const prose = page
    .replace(/<br>/g, ' ')
    // Synonyms for the subject of a guide. A generated page has them in its text.
    .replace('</h1>', aliases.length ? `</h1><p>${html(aliases.join(' · '))}</p>` : '</h1>')
    .replace(/<(FrameBytes|SequencePicture|StatePicture|DoorLayout|ByteRuler|QuestionFilter|AudienceFilter|FrameLab)\b[^>]*>/g, '')
    .replace(/<p class="fc-badges">[\s\S]*?<\/p>/g, '')
    .replace(/<div class="language-[\s\S]*?<\/pre>[\s\S]*?<\/div>/g, '')
    .replace(/<div class="fc-samples"[^>]*>(?:<input[^>]*><label[^>]*>[^<]*<\/label>)*/g, '<div>')
  const language: 'zh' | 'en' = env.relativePath?.startsWith('en/') ? 'en' : 'zh'
  if (/reference\/codes\.md$/.test(env.relativePath ?? '')) return prose + unusedCodes(page, language)
  const found = operationOf(env.relativePath ?? '')
  if (!found) return prose
  const { operation, group } = found
  const code = operation.code === null ? [] : [hexNumber(operation.code, 4), String(operation.code)]
  const title = ['', operation.name, ...code].join(' · ')
  const context = `<p>${html(`${group[language]} ${group.about?.[language] ?? ''}`)} ${HIDDEN}${namesIn(page, operation.name)}</p>`
  const [head, ...sections] = prose.split(/(?=<h2\b)/)
  const own = sections.filter((section) => !COMMON.test(/<h2 id="([^"]*)"/.exec(section)?.[1] ?? ''))
  return (
    head.replace(/( ?<a class="header-anchor"[\s\S]*?<\/h1>)/, (_, end) => title + end + context) +
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

