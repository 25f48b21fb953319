// Terms of the local search. VitePress ships these functions to the browser as text, so each must
// stand on its own: no imports, no helpers outside its body.

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
