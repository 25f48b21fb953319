// The local search: the terms of a page, the order of hits, and their text.
//
// VitePress ships these functions to the browser as text. Each must be complete: no imports, no helpers outside of it.

/** Begins the terms of a section that are searched but not shown. The functions below contain a copy. */
export const HIDDEN = '\u2063'

/**
 * Terms of a page: its words and numbers. A name also adds its parts, and itself without underscores: `robot_sn` →
 * `robot`, `sn`, `robotsn`. A hexadecimal number is also a term without its prefix and its zeros: `0x0A01` → `0A01`,
 * `A01`. Chinese has no spaces, so every pair of neighbouring characters is a term.
 */
export function indexTerms(text: string): string[] {
  const terms: string[] = []
  for (const run of text.match(/[A-Za-z0-9_]+|[\u3400-\u9fff\uf900-\ufaff]+/g) ?? []) {
    if (/^0[xX][0-9A-Fa-f]+$/.test(run)) {
      const bare = run.slice(2)
      const short = bare.replace(/^0+(?=.)/, '')
      terms.push(run, bare)
      if (short !== bare) terms.push(short, '0x' + short)
    } else if (/^[A-Za-z0-9_]/.test(run)) {
      terms.push(run)
      const parts = run.split(/_+|(?<=[a-z0-9])(?=[A-Z])/).filter(Boolean)
      if (parts.length > 1) terms.push(...parts)
      if (run.includes('_')) terms.push(parts.join(''))
    } else {
      for (const character of run) terms.push(character)
      for (let at = 0; at + 1 < run.length; at++) terms.push(run.slice(at, at + 2))
    }
  }
  return terms
}

/**
 * Terms of a query: its words. A name adds its parts, joined in each way that a language may join them. A code adds its
 * block of codes. Chinese adds pairs, and a single character only if the query has no more. Otherwise 充电 would match
 * every page with 电. Question words (how, 怎么) are ignored, unless the query has no others.
 */
export function queryTerms(query: string): string[] {
  const terms = (text: string) => {
    const found: string[] = []
    for (const run of text.match(/[A-Za-z0-9_]+|[\u3400-\u9fff\uf900-\ufaff]+/g) ?? []) {
      if (/^0[xX][0-9A-Fa-f]{1,4}$/.test(run)) {
        const code = `0x${run.slice(2).padStart(4, '0')}`
        found.push(run, `${code.slice(0, 4)}xx`, `${code.slice(0, 5)}x`)
      } else if (/^[A-Za-z0-9_]/.test(run)) {
        found.push(run)
        // `GetRobotSnRequest`: its parts are terms, because no page has the whole name.
        const parts = run.split(/_+|(?<=[a-z0-9])(?=[A-Z])/).filter(Boolean)
        if (parts.length < 2 || parts.length > 8) continue
        for (let from = 0; from < parts.length; from++) {
          for (let to = from + 1; to <= parts.length; to++) found.push(parts.slice(from, to).join(''))
        }
      } else if (run.length === 1) found.push(run)
      else for (let at = 0; at + 1 < run.length; at++) found.push(run.slice(at, at + 2))
    }
    return found
  }
  const told = query
    .replace(/怎么样|怎么办|怎么|怎样|如何|为什么|什么|是多少|多少|请问|哪些|哪个|哪里|有没有|能不能|可以|(?<!目)的|吗|呢/g, ' ')
    .replace(
      /\b(?:how|what|which|where|when|why|who|is|are|was|do|does|did|can|could|should|i|we|you|my|it|its|the|a|an|of|to|in|on|for|from|by|with|and|or|there|please)\b/gi,
      ' ',
    )
  const found = terms(told)
  return found.length ? found : terms(query)
}

/**
 * The weight of a hit by its page. The head of an operation's page has the largest weight, then pages about all
 * operations, then lists. Pages for authors of the spec come last.
 */
export function weight(id: string, _term: string, stored?: Record<string, unknown>): number {
  const page = id.split('#')[0]
  let weight = 1
  if (/\/reference\/(commands|reports|streams)\//.test(page)) weight = 3
  else if (/\/reference\/(wire|results)\.html$/.test(page)) weight = 2
  else if (/\/reference\/codes\.html$|\/reference\/$/.test(page)) weight = 0.4
  else if (/\/reference\/(changelog|open-questions)\.html$/.test(page)) weight = 0.1
  // The owner of the protocol needs these.
  else if (/\/reference\/(language|errors|cli)\.html$/.test(page)) weight = 0.1
  else if (/\/guides\/(adding-a-command|changing-safely|editors|answers|releases|targets|lint|what-changed)\.html$/.test(page)) weight = 0.3
  // A section without a parent is the head of its page.
  const head = Array.isArray(stored?.titles) && stored.titles.length === 0
  return head ? weight * 3 : weight
}

/**
 * Prepares each hit before sorting. A hit with more words of the query comes first: a long question still finds
 * something, and an exact one finds its page first.
 *
 * The hit shows its surrounding text. The heading joins the path, and the text takes the heading's line, because
 * VitePress has no other line for it. Its own excerpts would fetch and draw the whole page of each hit.
 */
export function finish(hit: Record<string, any>): boolean {
  hit.score *= 4 ** new Set(hit.queryTerms).size
  const text = String(hit.text ?? '')
    .replace(/\u2063[^]*$/, '')
    .replace(/&(?:#\w+|\w+);/g, (entity) => ({ '&quot;': '"', '&#39;': "'", '&amp;': '&' })[entity] ?? ' ')
    .replace(/\s+/g, ' ')
    .trim()
  const lower = text.toLowerCase()
  // The longest word is the most specific: a pair before one character.
  const words = [...hit.terms].sort((a: string, b: string) => b.length - a.length)
  const at = words.map((word: string) => lower.indexOf(word)).find((place) => place >= 0) ?? 0
  const chinese = /[\u3400-\u9fff]/.test(text.slice(at, at + 40))
  const [before, after] = chinese ? [12, 48] : [30, 110]
  let from = Math.max(0, at - before)
  // The text begins with a whole word.
  if (from > 0 && !chinese) from = text.indexOf(' ', from) + 1 || from
  const excerpt = (from > 0 ? '…' : '') + text.slice(from, at + after) + (at + after < text.length ? '…' : '')
  if (text) Object.assign(hit, { titles: [...hit.titles, hit.title], title: excerpt.replace(/[<>&]/g, ' ') })
  return true
}

/** Options of the index and of a search. */
export const miniSearch = {
  options: { tokenize: indexTerms, storeFields: ['title', 'titles', 'text'] },
  searchOptions: {
    tokenize: queryTerms,
    combineWith: 'OR' as const,
    fuzzy: false,
    prefix: true,
    boost: { title: 6, titles: 2, text: 1 },
    boostDocument: weight,
    filter: finish,
  },
}
