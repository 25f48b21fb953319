import { Client } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'

const client = await Client.connect(nodePlatform, { host: '127.0.0.1', commandPort: Number(process.argv[2]) })
const { data } = await client.getRobotSn()
console.log(data.robotSn)
client.close()
