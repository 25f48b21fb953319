// Pages that do not come: those that the site does not have, and those that the browser cannot fetch.

import type { Router, SiteData } from 'vitepress'
import type { Ref } from 'vue'

/** The pages of the site by the names of their files, as VitePress leaves them in the page. */
const pages = (): Record<string, string> => (globalThis as { __VP_HASH_MAP__?: Record<string, string> }).__VP_HASH_MAP__ ?? {}

/** Whether the site has a page at this address. */
export function isPage(address: string, base: string): boolean {
  const below = decodeURIComponent(address.slice(base.length)).replace(/\.html$/, '').replace(/(^|\/)$/, '$1index')
  const name = below.replaceAll('/', '_').toLowerCase()
  return `${name}.md` in pages() || `${name}_index.md` in pages()
}

/** VitePress names a missing page with the base in front, and would take its language from that. */
export function namePagesBelowBase(router: Router, siteData: Ref<SiteData>): void {
  router.onAfterRouteChange = () => {
    const { data } = router.route
    const base = siteData.value.base.slice(1)
    if (data.isNotFound && base && data.relativePath.startsWith(base)) {
      router.route.data = { ...data, relativePath: data.relativePath.slice(base.length) }
    }
  }
}
