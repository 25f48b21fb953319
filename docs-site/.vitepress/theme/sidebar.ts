// The sidebar is longer than most screens: the item of the page that is open is scrolled into view.

/** Scrolls the sidebar, and nothing else, to the item of this page, unless it shows already. */
export function showActiveItem(): void {
  // The sidebar opens the group of the page first.
  requestAnimationFrame(() => {
    const sidebar = document.querySelector<HTMLElement>('.VPSidebar')
    const item = sidebar?.querySelector<HTMLElement>('.VPSidebarItem.is-link.is-active > .item')
    if (!sidebar || !item) return
    const { top, bottom } = item.getBoundingClientRect()
    const frame = sidebar.getBoundingClientRect()
    const bar = Number.parseFloat(getComputedStyle(sidebar).paddingTop)
    if (top >= frame.top + bar && bottom <= frame.bottom) return
    sidebar.scrollTop += (top + bottom) / 2 - (frame.top + frame.bottom) / 2
  })
}
