import { existsSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { defineConfig, type DefaultTheme } from 'vitepress'
import { drawnFences } from './fences'
import { indexTerms, queryTerms } from './search'

/** What `fc generate` writes beside the pages: groups and their operations, in both languages. */
interface Navigation {
  groups: { zh: string; en: string; items: { zh: string; en: string; link: string }[] }[]
}

const navigationFile = fileURLToPath(new URL('../reference/navigation.json', import.meta.url))
const navigation: Navigation = existsSync(navigationFile)
  ? JSON.parse(readFileSync(navigationFile, 'utf8'))
  : { groups: [] }

type Language = 'zh' | 'en'

/** The sidebar: guides by hand, the reference by group. */
function sidebar(language: Language): DefaultTheme.SidebarItem[] {
  const base = language === 'zh' ? '' : '/en'
  const pick = (zh: string, en: string) => (language === 'zh' ? zh : en)
  return [
    {
      text: pick('指南', 'Guides'),
      items: [
        { text: pick('五分钟完成第一次调用', 'First call in five minutes'), link: `${base}/guides/first-call` },
        { text: pick('新增一条指令', 'Adding a command'), link: `${base}/guides/adding-a-command` },
        { text: pick('读懂抓包', 'Reading a capture'), link: `${base}/guides/reading-a-capture` },
        { text: pick('移植到其他语言', 'Porting to another language'), link: `${base}/guides/porting` },
        { text: pick('与旧文档的差异', 'What changed from the old document'), link: `${base}/guides/what-changed` },
      ],
    },
    {
      text: pick('协议', 'Protocol'),
      items: [
        { text: pick('总览', 'Map of the protocol'), link: `${base}/reference/` },
        { text: pick('帧格式', 'Wire format'), link: `${base}/reference/wire` },
        { text: pick('功能码', 'Command codes'), link: `${base}/reference/codes` },
        { text: pick('类型', 'Types'), link: `${base}/reference/types` },
        { text: pick('格口布局', 'Cell layouts'), link: `${base}/reference/tables` },
        { text: pick('结果码', 'Result codes'), link: `${base}/reference/results` },
        { text: pick('变更记录', 'Changelog'), link: `${base}/reference/changelog` },
        { text: pick('待确认问题', 'Open questions'), link: `${base}/reference/open-questions` },
        { text: pick('帧实验室', 'Frame laboratory'), link: `${base}/lab/` },
      ],
    },
    ...navigation.groups.map((group) => ({
      text: group[language],
      collapsed: true,
      items: group.items.map((item) => ({ text: item[language], link: `${base}/reference/${item.link}` })),
    })),
  ]
}

const search: DefaultTheme.LocalSearchOptions = {
  detailedView: false,
  miniSearch: {
    options: { tokenize: indexTerms },
    searchOptions: {
      tokenize: queryTerms,
      combineWith: 'AND',
      fuzzy: false,
      prefix: true,
      boost: { title: 6, titles: 2, text: 1 },
    },
  },
  locales: {
    root: {
      translations: {
        button: { buttonText: '搜索', buttonAriaLabel: '搜索' },
        modal: {
          displayDetails: '显示详情',
          resetButtonTitle: '清除',
          backButtonTitle: '返回',
          noResultsText: '没有找到',
          footer: { selectText: '打开', navigateText: '切换', closeText: '关闭' },
        },
      },
    },
  },
}

export default defineConfig({
  title: 'FC',
  cleanUrls: false,
  lastUpdated: false,
  srcExclude: ['README.md', 'tests/**', 'node_modules/**'],
  // Pages link to lines of the spec, which are not part of the site.
  ignoreDeadLinks: false,
  head: [['link', { rel: 'icon', type: 'image/svg+xml', href: '/mark.svg' }]],
  markdown: { theme: { light: 'github-light', dark: 'github-dark' }, config: drawnFences },
  locales: {
    root: {
      label: '简体中文',
      lang: 'zh-CN',
      title: 'FC 协议',
      description: 'FC 配送机器人通信协议：指令、帧格式与实验室',
      themeConfig: {
        nav: [
          { text: '指南', link: '/guides/first-call', activeMatch: '^/guides/' },
          { text: '协议', link: '/reference/', activeMatch: '^/reference/' },
          { text: '帧实验室', link: '/lab/', activeMatch: '^/lab/' },
        ],
        sidebar: sidebar('zh'),
        outline: { label: '本页内容', level: [2, 3] },
        docFooter: { prev: '上一页', next: '下一页' },
        darkModeSwitchLabel: '主题',
        lightModeSwitchTitle: '切换到浅色',
        darkModeSwitchTitle: '切换到深色',
        sidebarMenuLabel: '目录',
        returnToTopLabel: '回到顶部',
        langMenuLabel: '切换语言',
        notFound: {
          title: '没有这一页',
          quote: '地址可能写错了，或者这条指令已经改名。',
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
      description: 'The FC delivery robot protocol: commands, frames and a laboratory',
      themeConfig: {
        nav: [
          { text: 'Guides', link: '/en/guides/first-call', activeMatch: '^/en/guides/' },
          { text: 'Protocol', link: '/en/reference/', activeMatch: '^/en/reference/' },
          { text: 'Frame laboratory', link: '/en/lab/', activeMatch: '^/en/lab/' },
        ],
        sidebar: sidebar('en'),
        outline: { label: 'On this page', level: [2, 3] },
      },
    },
  },
  themeConfig: {
    logo: '/mark.svg',
    i18nRouting: true,
    search: { provider: 'local', options: search },
  },
})
