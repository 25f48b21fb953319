// An app and a robot that use what `noise.yaml` adds.

import { PartialRobot } from './generated/index.ts'
import type {
  Client,
  MeasureNoiseRequest,
  MeasureNoiseResponse,
  NoiseBand,
  NoiseChanged,
  Reporter,
} from './generated/index.ts'

export class Ear extends PartialRobot {
  override measureNoise({ seconds }: MeasureNoiseRequest): MeasureNoiseResponse {
    const band: NoiseBand = { hertz: 1000, level: seconds }
    return { bands: [band] }
  }
}

export async function firstLevel(client: Client): Promise<number | undefined> {
  const { bands } = await client.measureNoise({ seconds: 3 })
  return bands[0]?.level
}

export async function heard(client: Client): Promise<number | null> {
  for await (const report of client.reports()) {
    if (report.case === 'NoiseChanged') return report.value.loudest.hertz
  }
  return null
}

export async function tell(reporter: Reporter): Promise<number> {
  const report: NoiseChanged = { loudest: { hertz: 1000 } }
  return (await reporter.noiseChanged(report)).length
}
