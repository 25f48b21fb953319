// The sidebar is longer than most screens, so the item of the open page is scrolled into view.

/** Scrolls only the sidebar to the item of this page, unless the item is visible. */
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
