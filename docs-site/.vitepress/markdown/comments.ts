// Samples of JSON with comments: a reader sees them, but what is copied is JSON without them.

import type { ShikiTransformer } from 'shiki'

export const commentsStayBehind: ShikiTransformer = {
  name: 'fc-comments',
  span(node) {
    if (this.options.lang !== 'jsonc') return
    const [text] = node.children
    // VitePress leaves what has this class behind when it copies.
    if (text?.type === 'text' && text.value.trimStart().startsWith('//')) this.addClassToHast(node, 'vp-copy-ignore')
  },
}
