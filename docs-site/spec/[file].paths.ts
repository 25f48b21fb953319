import { specPages } from '../.vitepress/spec-pages'

export default { paths: specPages }
