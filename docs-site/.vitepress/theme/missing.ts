// Missing pages: the site lacks them, or the browser cannot fetch them.

import type { Router, SiteData } from 'vitepress'
import type { Ref } from 'vue'

/** The pages of the site by file name, as VitePress lists them in the page. */
const pages = (): Record<string, string> => (globalThis as { __VP_HASH_MAP__?: Record<string, string> }).__VP_HASH_MAP__ ?? {}

/** Returns `true` if the site has a page at this address. */
export function isPage(address: string, base: string): boolean {
  const below = decodeURIComponent(address.slice(base.length)).replace(/\.html$/, '').replace(/(^|\/)$/, '$1index')
  const name = below.replaceAll('/', '_').toLowerCase()
  return `${name}.md` in pages() || `${name}_index.md` in pages()
}

/** VitePress adds the base to the name of a missing page, and would derive the language from it. */
export function namePagesBelowBase(router: Router, siteData: Ref<SiteData>): void {
  router.onAfterRouteChange = () => {
    const { data } = router.route
    const base = siteData.value.base.slice(1)
    if (data.isNotFound && base && data.relativePath.startsWith(base)) {
      router.route.data = { ...data, relativePath: data.relativePath.slice(base.length) }
    }
  }
}
