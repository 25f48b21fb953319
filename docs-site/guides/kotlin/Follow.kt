// An app in Kotlin that sends its robot to the dock and follows it there.
@file:JvmName("Follow")

import fc.Client
import fc.Fc
import fc.PartialRobot
import fc.RechargeError
import fc.RechargeProgress
import fc.RechargeProgressData
import fc.RechargeStatus
import fc.Reporter
import fc.StartRechargeRequest
import fc.StartRechargeResponse
import fc.runtime.Audience
import fc.runtime.CallError
import fc.runtime.ClientConfig
import fc.runtime.Context
import fc.runtime.Followed
import fc.runtime.Server
import fc.runtime.ServerConfig
import fc.service
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.launch
import kotlinx.coroutines.runBlocking

// #region follow
suspend fun recharge(client: Client) {
    try {
        client.startRechargeFollowed().asFlow().collect { next ->
            when (next) {
                is Followed.Going -> println("on its way: ${next.report.data.rechargeStatus}")
                is Followed.Ended -> println("it charges")
                is Followed.Failed -> println("it cannot: ${next.report.data.errorStatus}")
                // 其间的上报可能不会再来：去查询。
                // What was reported meanwhile may never come: ask.
                is Followed.Missed, is Followed.Interrupted, is Followed.Resumed ->
                    println(client.getRechargeStatus().data.rechargeStatus)
            }
        }
    } catch (error: CallError) {
        println("not begun: ${error.name}")
    }
}
// #endregion follow

/** A robot that sets off when it is asked to. */
class DockingRobot : PartialRobot {
    val asked: CompletableDeferred<Unit> = CompletableDeferred()

    override suspend fun startRecharge(
        context: Context,
        request: StartRechargeRequest,
    ): StartRechargeResponse {
        asked.complete(Unit)
        return StartRechargeResponse.example()
    }
}

/** It says how far it has come, and in the end that it cannot go on. */
suspend fun drive(reporter: Reporter) {
    val steps = listOf(
        RechargeStatus.NAVIGATING to RechargeError.OK,
        RechargeStatus.AT_UNDOCK_POINT to RechargeError.OK,
        RechargeStatus.AT_UNDOCK_POINT to RechargeError.FAILED,
    )
    for ((status, error) in steps) {
        val data = RechargeProgressData { rechargeStatus(status).errorStatus(error) }
        reporter.rechargeProgress(Audience.ALL, RechargeProgress { data(data) })
    }
}

fun main(): Unit = runBlocking {
    val robot = DockingRobot()
    val here = ServerConfig().address("127.0.0.1").commandPort(0).dataPort(0)
    val server = Server.bind(Fc, robot.service(), here)
    val there = ClientConfig().host("127.0.0.1").commandPort(server.commandAddress.port)
    Client.connect(there).use { client ->
        val following = launch { recharge(client) }
        robot.asked.await()
        drive(Reporter(server))
        following.join()
    }
    server.close()
}
