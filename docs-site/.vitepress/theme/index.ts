import type { Theme } from 'vitepress'
import DefaultTheme from 'vitepress/theme-without-fonts'
import { defineAsyncComponent } from 'vue'
import DoorLayout from './components/DoorLayout.vue'
import FrameBytes from './components/FrameBytes.vue'
import SequencePicture from './components/SequencePicture.vue'
import './style.css'

export default {
  extends: DefaultTheme,
  enhanceApp({ app }) {
    app.component('DoorLayout', DoorLayout)
    app.component('FrameBytes', FrameBytes)
    app.component('SequencePicture', SequencePicture)
    // The laboratory knows the whole protocol: only its own page loads it.
    app.component('FrameLab', defineAsyncComponent(() => import('./components/FrameLab.vue')))
  },
} satisfies Theme
