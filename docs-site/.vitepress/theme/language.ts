// The reader's language, for components with texts in both languages.

import { computed } from 'vue'
import { useData } from 'vitepress'

export function useLanguage() {
  const { lang } = useData()
  const english = computed(() => lang.value.startsWith('en'))
  return {
    english,
    say: (zh: string, en: string) => (english.value ? en : zh),
    told: (text: { zh: string; en: string } | null | undefined) => (text ? (english.value ? text.en : text.zh) : ''),
  }
}
