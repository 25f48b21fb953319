// The first call in Kotlin, from both ends: a robot that has two commands so far, and an app that
// calls one and takes a report.
@file:JvmName("FirstCall")

import fc.Client
import fc.Fc
import fc.GetRobotSnRequest
import fc.GetRobotSnResponse
import fc.GetRobotSnResponseData
import fc.PartialRobot
import fc.RechargeError
import fc.RechargeProgress
import fc.RechargeProgressData
import fc.RechargeStatus
import fc.Reporter
import fc.ResultCode
import fc.StartRechargeRequest
import fc.StartRechargeResponse
import fc.runtime.AckOutcome
import fc.runtime.Audience
import fc.runtime.ClientConfig
import fc.runtime.Context
import fc.runtime.Reports
import fc.runtime.Server
import fc.runtime.ServerConfig
import fc.service
import kotlinx.coroutines.async
import kotlinx.coroutines.flow.first
import kotlinx.coroutines.runBlocking

// #region robot
class MyRobot : PartialRobot {
    override suspend fun getRobotSn(
        context: Context,
        request: GetRobotSnRequest,
    ): GetRobotSnResponse {
        val data = GetRobotSnResponseData { robotSn("100132007654321").robotModel("Indoor") }
        return GetRobotSnResponse { data(data) }
    }

    // 这里没有充电桩。There is no dock here.
    override suspend fun startRecharge(
        context: Context,
        request: StartRechargeRequest,
    ): StartRechargeResponse = throw ResultCode.INVALID_PARAMETER.refusal()
}
// #endregion robot

// #region report
suspend fun report(reporter: Reporter): Int {
    val data = RechargeProgressData {
        rechargeStatus(RechargeStatus.AT_UNDOCK_POINT).errorStatus(RechargeError.OK)
    }
    // 等到每个 app 应答，或重发次数用完。
    // Waits until every app has acknowledged it, or the repetitions are used up.
    val ended = reporter.rechargeProgress(Audience.ALL, RechargeProgress { data(data) })
    return ended.count { it.outcome == AckOutcome.ACKNOWLEDGED }
}
// #endregion report

// #region app
suspend fun app(client: Client) {
    val answer = client.getRobotSn()
    println("app: the robot is ${answer.data.robotSn}")
}
// #endregion app

// #region listen
suspend fun listen(reports: Reports) {
    reports.asFlow().first { report ->
        val message = report.message
        if (message is RechargeProgress) {
            println("app: recharging is at ${message.data.rechargeStatus}")
        }
        message is RechargeProgress
    }
}
// #endregion listen

fun main(): Unit = runBlocking {
    // #region serve
    // 端口 0：由系统分配。不写就是协议规定的端口。
    // Port 0 is any that is free; without it, the ports of the protocol.
    val config = ServerConfig().address("127.0.0.1").commandPort(0).dataPort(0)
    val server = Server.bind(Fc, MyRobot().service(), config)
    // #endregion serve

    val port = server.commandAddress.port
    // #region connect
    Client.connect(ClientConfig().host("127.0.0.1").commandPort(port)).use { client ->
        app(client)
        // #endregion connect
        client.reports().use { reports ->
            val acknowledged = async { report(Reporter(server)) }
            listen(reports)
            println("robot: ${acknowledged.await()} app has acknowledged")
        }
    }
    server.close()
}
