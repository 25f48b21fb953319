import { onContentUpdated, type Theme } from 'vitepress'
import DefaultTheme from 'vitepress/theme-without-fonts'
import Layout from './Layout.vue'
import { showActiveItem } from './sidebar'
import { defineAsyncComponent, onMounted } from 'vue'
import ByteRuler from './components/ByteRuler.vue'
import DoorLayout from './components/DoorLayout.vue'
import FrameBytes from './components/FrameBytes.vue'
import SequencePicture from './components/SequencePicture.vue'
import StatePicture from './components/StatePicture.vue'
import { namePagesBelowBase } from './missing'
import { followChoice, pressRemembered } from './samples'
import './style.css'
import './lab.css'

export default {
  extends: DefaultTheme,
  Layout,
  setup() {
    onContentUpdated(pressRemembered)
    onContentUpdated(showActiveItem)
    onMounted(followChoice)
  },
  enhanceApp({ app, router, siteData }) {
    namePagesBelowBase(router, siteData)
    app.component('ByteRuler', ByteRuler)
    app.component('DoorLayout', DoorLayout)
    app.component('FrameBytes', FrameBytes)
    app.component('SequencePicture', SequencePicture)
    app.component('StatePicture', StatePicture)
    // Only the page of the lab loads it, because the lab contains the whole protocol.
    app.component('FrameLab', defineAsyncComponent(() => import('./components/FrameLab.vue')))
    app.component('ProtocolMap', defineAsyncComponent(() => import('./components/ProtocolMap.vue')))
    app.component('AudienceFilter', defineAsyncComponent(() => import('./components/AudienceFilter.vue')))
    app.component('QuestionFilter', defineAsyncComponent(() => import('./components/QuestionFilter.vue')))
  },
} satisfies Theme
