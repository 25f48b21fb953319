import { existsSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { defineConfig, type DefaultTheme, type HeadConfig } from 'vitepress'
import { commentsStayBehind } from './markdown/comments'
import { drawnFences } from './markdown/fences'
import { anchoredHeadings } from './markdown/headings'
import { html } from './markdown/html'
import { API, referencePages } from './markdown/pages'
import { samples } from './markdown/samples'
import { leadOn, movedFrom } from './moved'
import { navigation } from './navigation'
import { searchOptions } from './search'
import { specFiles } from './spec-pages'
import { PRESS_AT_ONCE } from './theme/samples'

type Language = 'zh' | 'en'

/** The guides, in the order of reading. */
const GUIDES: [page: string, zh: string, en: string][] = [
  ['first-call', '五分钟完成第一次调用', 'First call in five minutes'],
  ['first-call-typescript', '第一次调用：TypeScript', 'First call in TypeScript'],
  ['first-call-python', '第一次调用：Python', 'First call in Python'],
  ['first-call-kotlin', '第一次调用：Kotlin 和 Java', 'First call in Kotlin and Java'],
  ['first-call-cpp', '第一次调用：C++', 'First call in C++'],
  ['first-call-steps', '第一次调用：通用步骤', 'First call: common steps'],
  ['in-your-project', '用到自己的项目里', 'Use it in your project'],
  ['connection', '连接的生命周期：app', 'Connection life: apps'],
  ['connection-robot', '连接的生命周期：机器人', 'Connection life: robots'],
  ['data-port', '数据端口', 'The data port'],
  ['operations', '运维', 'Operations'],
  ['adding-a-command', '新增一条指令', 'Adding a command'],
  ['changing-safely', '安全地修改协议', 'Changing the protocol safely'],
  ['editors', '在编辑器里', 'In your editor'],
  ['answers', '协议负责人的答复', 'The owner\'s answers'],
  ['releases', '发布、豁免与变更记录', 'Releases, waivers and changelogs'],
  ['targets', '生成目标和目录', 'Targets and directories'],
  ['lint', '团队规则与规范检查', 'House rules and the lint'],
  ['workshop', '联调工具', 'Workshop'],
  ['reading-a-capture', '分析抓包', 'Reading a capture'],
  ['porting', '移植到其他语言', 'Porting to another language'],
  ['what-changed', '与旧文档的差异', 'Changes from the old document'],
  ['promises', '可靠性保证', 'Guarantees'],
  ['limits', '限制', 'Limits'],
  ['packages', '各语言软件包对比', 'Packages compared'],
  ['testing', '测试方法', 'How it is tested'],
  ['performance', '性能', 'Performance'],
  ['performance-results', '性能测试结果', 'Performance results'],
]

const REFERENCE: [page: string, zh: string, en: string][] = [
  ['reference/', '协议总览', 'Protocol overview'],
  ['reference/wire', '传输与帧', 'Transport and frames'],
  ['reference/codes', '功能码', 'Command codes'],
  ['reference/types', '公共类型', 'Shared types'],
  ['reference/tables', '常量表', 'Tables'],
  ['reference/results', '结果码', 'Result codes'],
  ['reference/entities', '实体与 ID', 'Entities and their IDs'],
  ['reference/places', '坐标系与存储位置', 'Coordinates and storage'],
  ['reference/glossary', '术语', 'Glossary'],
  ['reference/changelog', '变更记录', 'Changelog'],
  ['reference/open-questions', '疑问与决定', 'Open questions'],
  ['reference/language', '规范的写法', 'The spec language'],
  ['reference/errors', '规范检查错误', 'Errors in the spec'],
  ['reference/cli', '命令行', 'Command line'],
  ['lab/', '帧实验室', 'Frame lab'],
]

const written = (page: string) => existsSync(fileURLToPath(new URL(`../${page}.md`, import.meta.url)))

/** The sidebar: the handwritten guides, the reference by group, the sources of the spec. */
function sidebar(language: Language): DefaultTheme.SidebarItem[] {
  const base = language === 'zh' ? '/' : '/en/'
  const pick = (zh: string, en: string) => (language === 'zh' ? zh : en)
  return [
    {
      text: pick('指南', 'Guides'),
      items: GUIDES.filter(([page]) => written(`guides/${page}`)).map(([page, zh, en]) => ({
        text: pick(zh, en),
        link: `${base}guides/${page}`,
      })),
    },
    {
      text: pick('协议', 'Protocol'),
      items: REFERENCE.map(([page, zh, en]) => ({ text: pick(zh, en), link: base + page })),
    },
    // The theme shows these texts as HTML.
    ...navigation.groups.map((group) => ({
      text: html(group[language]),
      collapsed: true,
      items: group.items.map((item) => ({ text: html(item[language]), link: `${base}reference/${item.link}` })),
    })),
    {
      text: pick('协议源文件', 'Protocol sources'),
      collapsed: true,
      items: specFiles().map((file) => ({ text: html(`${file}.yaml`), link: `${base}spec/${file}` })),
    },
  ]
}

const nav = (base: string, words: [string, string, string]) => [
  { text: words[0], link: `${base}guides/first-call`, activeMatch: `^${base}guides/` },
  { text: words[1], link: `${base}reference/`, activeMatch: `^${base}(reference|spec)/` },
  { text: words[2], link: `${base}lab/`, activeMatch: `^${base}lab/` },
]

export default defineConfig({
  title: 'FC',
  cleanUrls: false,
  lastUpdated: false,
  srcExclude: ['README.md', 'tests/**', 'node_modules/**'],
  ignoreDeadLinks: [API],
  head: [
    ['meta', { name: 'theme-color', content: '#0f766e' }],
    ['script', {}, PRESS_AT_ONCE],
    // Without scripts, parts that need them are hidden.
    ['noscript', {}, '<style>.fc-scripted { display: none !important; } .fc-rest, .fc-unscripted { display: block; }</style>'],
  ],
  markdown: {
    theme: { light: 'github-light-high-contrast', dark: 'github-dark-high-contrast' },
    codeTransformers: [commentsStayBehind],
    config: (md) => {
      anchoredHeadings(md)
      samples(md)
      drawnFences(md)
      referencePages(md)
    },
  },
  // The lab runs on the TypeScript package.
  vite: { server: { fs: { allow: [fileURLToPath(new URL('../../stubs/typescript', import.meta.url))] } } },
  transformPageData(page) {
    if (page.params?.title) page.title = page.params.title
  },
  transformHead({ pageData, siteData }) {
    const moved = movedFrom(pageData.relativePath)
    // VitePress adds no base to links in the head.
    const icon: HeadConfig = ['link', { rel: 'icon', type: 'image/svg+xml', href: `${siteData.base}mark.svg` }]
    return moved ? [icon, ['script', {}, leadOn(moved)]] : [icon]
  },
  locales: {
    root: {
      label: '简体中文',
      lang: 'zh-CN',
      title: 'FC 协议',
      description: 'FC 配送机器人通信协议：指令、帧格式与实验室',
      themeConfig: {
        nav: nav('/', ['指南', '协议', '帧实验室']),
        sidebar: sidebar('zh'),
        outline: { label: '本页内容', level: [2, 3] },
        docFooter: { prev: '上一页', next: '下一页' },
        darkModeSwitchLabel: '主题',
        lightModeSwitchTitle: '切换到浅色',
        darkModeSwitchTitle: '切换到深色',
        sidebarMenuLabel: '目录',
        returnToTopLabel: '回到顶部',
        langMenuLabel: '切换语言',
        skipToContentLabel: '跳到正文',
        notFound: {
          title: '页面不存在',
          quote: '地址可能有误，或者这条指令已经改名。请用右上角的搜索按功能码或名称查找。',
          linkLabel: '回到首页',
          linkText: '回到首页',
        },
      },
    },
    en: {
      label: 'English',
      lang: 'en',
      link: '/en/',
      title: 'FC protocol',
      description: 'The FC delivery robot protocol: commands, frame format and a frame lab',
      themeConfig: {
        nav: nav('/en/', ['Guides', 'Protocol', 'Frame lab']),
        sidebar: sidebar('en'),
        outline: { label: 'On this page', level: [2, 3] },
        notFound: {
          title: 'Page not found',
          quote: 'The address may be wrong, or the command has been renamed. Search for its code or name instead.',
          linkLabel: 'Back to the home page',
          linkText: 'Back to the home page',
        },
      },
    },
  },
  themeConfig: {
    logo: '/mark.svg',
    i18nRouting: true,
    externalLinkIcon: true,
    search: { provider: 'local', options: searchOptions },
  },
})
