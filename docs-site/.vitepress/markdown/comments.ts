// Samples of JSON with comments. The copy button leaves the comments out.

import type { ShikiTransformer } from 'shiki'

export const commentsStayBehind: ShikiTransformer = {
  name: 'fc-comments',
  span(node) {
    if (this.options.lang !== 'jsonc') return
    const [text] = node.children
    // VitePress does not copy elements of this class.
    if (text?.type === 'text' && text.value.trimStart().startsWith('//')) this.addClassToHast(node, 'vp-copy-ignore')
  },
}
